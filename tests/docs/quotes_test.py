# SPDX-License-Identifier: BSL-1.0
"""The code that the documents show is that of files that are compiled and run."""
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "docs" / "site"))
import markdown
import quote

source = """int main() {
  // [twice]
  const int a = 1;
    // [inner]
    const int b = 2;
    // [/inner]

  // [/twice]
}
"""
whole = ["int main() {", "  const int a = 1;", "    const int b = 2;", "", "}"]


def mistakes(document):
    return [sentence for _, sentence in quote.rewritten(document)[1]]


class Documents(unittest.TestCase):
    def test_show_what_is_compiled_and_run(self):
        documents = markdown.documents(quote.root)
        self.assertGreater(len(documents), 10)
        quotations = 0
        for document in documents:
            text = document.read_text()
            quotations += text.count("<!-- quote ")
            self.assertEqual(quote.rewritten(text), (text, []), document)
        self.assertGreaterEqual(quotations, 3)


class Quotations(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        before = quote.root
        self.addCleanup(lambda: setattr(quote, "root", before))
        quote.root = Path(folder.name)
        (quote.root / "main.cpp").write_text(source)

    def test_are_outdented_and_without_marks(self):
        self.assertEqual(quote.quoted("main.cpp", "twice"), ["const int a = 1;", "  const int b = 2;"])
        self.assertEqual(quote.quoted("main.cpp", "inner"), ["const int b = 2;"])
        self.assertEqual(quote.quoted("main.cpp", None), whole)

    def test_that_are_right_are_left_alone_also_in_a_list(self):
        for document in ("a\n<!-- quote main.cpp inner -->\n```cpp\nconst int b = 2;\n```\n\n```sh\nls\n```\n",
                         "1. a\n   <!-- quote main.cpp inner -->\n   ```cpp\n   const int b = 2;\n   ```\n"):
            self.assertEqual(quote.rewritten(document), (document, []))

    def test_that_are_old_are_told_and_written(self):
        document = "<!-- quote main.cpp inner -->\n```cpp\nconst int b = 3;\n```\n"
        after, told = quote.rewritten(document)
        self.assertEqual(told, [(2, "this is not what main.cpp has at [inner]")])
        self.assertEqual(after, document.replace("3", "2"))
        self.assertEqual(mistakes(after), [])

    def test_that_are_not_there_are_told_and_written(self):
        after, told = quote.rewritten("<!-- quote main.cpp inner -->\n\nb\n")
        self.assertEqual(told, [(2, "the fence with what main.cpp has at [inner] is not there")])
        self.assertEqual(after, "<!-- quote main.cpp inner -->\n```cpp\nconst int b = 2;\n```\n\nb\n")

    def test_that_are_wrong_are_refused(self):
        (quote.root / "twice.cpp").write_text(source + source)
        (quote.root / "empty.cpp").write_text("// [a]\n\n// [/a]\n")
        (quote.root / "left.cpp").write_text("// [a]\n  b;\nc;\n// [/a]\n")
        fence = "```cpp\nconst int b = 2;\n```\n"
        for document, told in {
            "<!-- quote other.cpp inner -->\n" + fence: "there is no file other.cpp",
            "<!-- quote main.cpp outer -->\n" + fence: "main.cpp must have one region from [outer] to [/outer]",
            "<!-- quote twice.cpp inner -->\n" + fence: "one region",
            "<!-- quote empty.cpp a -->\n" + fence: "nothing is quoted",
            "<!-- quote left.cpp a -->\n" + fence: "left of the first",
            "<!-- quote main.cpp -- inner -->\n": "a quote is a line",
            "a\n```cpp\nb\n```\n": "cpp without a line",
            "a\n```python\nb\n```\n": "python without a line",
            "a\n```cmake\nb\n```\n": "cmake without a line",
            "```sh\nls\n": "this fence has no end",
        }.items():
            with self.subTest(document):
                self.assertIn(told, mistakes(document)[0])
        self.assertEqual(mistakes("```sh\na\n```\n```text\nb\n```\n```\nc\n```\n"), [])
        # A quote belongs to the line below it alone.
        self.assertIn("cpp without a line", mistakes("<!-- quote main.cpp inner -->\n\n```cpp\nb\n```\n")[1])


if __name__ == "__main__":
    unittest.main()
