# SPDX-License-Identifier: BSL-1.0
"""docs/messages.md shows what compilers say: every sentence of the headers, and nothing that none of them prints."""
import re
import sys
import unittest
from pathlib import Path

root = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(root / "tests" / "must_not_compile"))
import check

page = (root / "docs" / "messages.md").read_text()


def sentences(code):
    """What static assertions say: literals that stand one after the other are one."""
    return {"".join(re.findall(r'"([^"]*)"', found)) for found in re.findall(r'"nysalt: [^"]*"(?:\s+"[^"]*")*', code)}


def expected(cases):
    """What the cases of a file expect to read, of one compiler or of all."""
    return {sentence for case in check.cases_of(cases) for _, sentence in case.expected}


def shown(document):
    """What a document quotes of our sentences, and the lines of its fences of text."""
    fences = re.findall(r"^```text\n(.*?)^```$", document, re.MULTILINE | re.DOTALL)
    return {line for fence in fences for line in fence.splitlines()} | set(
        re.findall(r"^> (nysalt: .+)$", document, re.MULTILINE))


def of_all(read, files):
    return set().union(*(read(file.read_text()) for file in files))


class Messages(unittest.TestCase):
    def setUp(self):
        self.sentences = of_all(sentences, (root / "include").rglob("*.hpp"))
        self.expected = of_all(expected, (root / "tests" / "must_not_compile").glob("*.cpp"))

    def test_of_the_headers_are_all_shown(self):
        self.assertGreater(len(self.sentences), 20)
        self.assertEqual(self.sentences - shown(page), set())

    def test_that_are_shown_are_said_by_a_compiler(self):
        self.assertGreater(len(shown(page)), 30)
        self.assertEqual(shown(page) - self.sentences - self.expected, set())

    def test_mostly_have_a_case(self):
        self.assertGreater(len(self.sentences & self.expected), len(self.sentences) / 2)

    def test_are_read_whole(self):
        self.assertEqual(sentences('static_assert(a, "nysalt: one "\n      "two");  g("nysalt: three", "four")'),
                         {"nysalt: one two", "nysalt: three"})
        cases = "// About.\n// expect: a\n//   b\n// expect GNU: c\nnamespace d {\ne;\n}  // namespace d\n// expect: f\n"
        self.assertEqual(expected(cases), {"a b", "c"})
        self.assertEqual(shown("> nysalt: a\n\n```text\nb\nc\n```\n\n> d\n\n```cpp\ne\n```\n"), {"nysalt: a", "b", "c"})


if __name__ == "__main__":
    unittest.main()
