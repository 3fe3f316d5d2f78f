# SPDX-License-Identifier: BSL-1.0
"""Sources and pages use the words of docs/notation.md; what is planted against them is found."""
import shutil
import sys
import tempfile
import unittest
from collections import Counter
from pathlib import Path

root = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(root / "tests" / "docs"))
import words

notation = (root / "docs/notation.md").read_text()


class OfTheProject(unittest.TestCase):
    def test_are_plain(self):
        places, wrong = words.found_in(root)
        self.assertEqual(wrong, [])
        counts = Counter((folder, word) for _, _, folder, word in places)
        rose, fell = words.judged(counts, words.recorded(root / "tests/docs/words_left.txt"))
        self.assertEqual(rose, [])
        print("\n".join(fell), file=sys.stderr)

    def test_are_looked_for_in_all_folders(self):
        files = Counter(words.folder_of(root, path) for path in words.files(root))
        self.assertEqual(set(files), set(words.folders))
        self.assertGreater(files["include"], 150)

    def test_that_are_not_used_are_many(self):
        self.assertGreaterEqual(set(words.words_not_used(notation)),
                                {"told", "stands", "whoever", "nobody", "so many", "at hand", "put away", "gone through",
                                 "cannot be", "stretch", "law", "alone", "look"})


class InACopy(unittest.TestCase):
    """One good file of each kind; a case plants something and says what must be found."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = Path(folder.name).resolve()
        (self.root / "tests/docs").mkdir(parents=True)
        (self.root / "tests/docs/words_left.txt").write_text("include 1 alone\n")
        (self.root / "docs").mkdir()
        shutil.copy(root / "docs/notation.md", self.root / "docs")
        self.write("include/a.hpp", "// A header alone.\nint a() { return '\"'; }  // \"a\"\n")
        self.write("python/a.py", '"""A module."""\nvalue = 1\n')
        self.write("README.md", "# Page\n\n`told` and\n\n```sh\nwhoever\n```\n")

    def write(self, name, text):
        (self.root / name).parent.mkdir(exist_ok=True)
        (self.root / name).write_text(text)

    def judged(self):
        places, wrong = words.found_in(self.root)
        counts = Counter((folder, word) for _, _, folder, word in places)
        rose, fell = words.judged(counts, words.recorded(self.root / "tests/docs/words_left.txt"))
        return wrong + rose, fell

    def test_nothing_is_found_in_good_files(self):
        self.assertEqual(self.judged(), ([], []))

    def test_its_is_no_identifier(self):
        self.write("src/b.cpp", "// its sign\nint f() {\n  const int its = 1;  // its value\n  return its;\n}\n")
        self.assertEqual([sentence.split(": `")[0] for sentence in self.judged()[0]], ["src/b.cpp:3", "src/b.cpp:4"])
        self.write("src/b.cpp", "")
        self.write("python/b.py", "its = 1\n")
        self.assertEqual(len(self.judged()[0]), 1)

    def test_no_message_ends_in_cannot_be(self):
        for text in ('"run: {} steps: cannot be"', '"a {} steps: "\n    "cannot be"', '"{} lags cannot be, take 1"',
                     'R"(so: cannot be)"'):
            self.write("src/b.cpp", f"void f() {{ refuse({text}, 3); }}\n")
            with self.subTest(text):
                self.assertIn("must CONDITION", self.judged()[0][0])
        self.write("src/b.cpp", 'void f() { refuse("{}: cannot be written: {}", 3); }\n')
        self.assertEqual(self.judged()[0], [])

    def test_a_word_that_is_not_used_is_found(self):
        for text in ("// What the loop is told.\n", "/* so\n   many */\n", "int a = 0;  ///< nobody's\n",
                     '#include "alone.hpp"\nauto a = "this "\n  "stands";\n', "// Throws for what cannot be.\n"):
            self.write("src/b.cpp", text)
            with self.subTest(text):
                rose, _ = self.judged()
                self.assertEqual(len(rose), 1)
                self.assertIn("1 times, 0 are recorded", rose[0])
        self.write("src/b.cpp", '#include "alone.hpp"\nint reported = 1;  // it cannot be written\n')
        self.assertEqual(self.judged()[0], [])
        for name in ("README.md", "python/b.py", "docs/site/b.py"):
            (self.root / name).parent.mkdir(exist_ok=True)
            self.write(name, "# It is told\n")
            with self.subTest(name):
                self.assertEqual(len(self.judged()[0]), 1)
            self.write(name, "")

    def test_a_name_counts_once_in_a_folder(self):
        self.write("src/b.cpp", "int is_told = 1;\nint f() { return is_told; }\n")
        self.write("src/c.cpp", "int g() { return is_told; }\n")
        rose, _ = self.judged()
        self.assertEqual(len(rose), 1)
        self.assertIn("'told (names)' 1 times, 0 are recorded", rose[0])

    def test_what_the_table_excepts_is_not_found(self):
        for text in ('const auto fpu_law = law("law");\n', 'refuse("--spread needs --start law");\n', "// Made by `law(system)`.\n",
                     'take("looks", looks);\n'):
            self.write("src/b.cpp", text)
            with self.subTest(text):
                self.assertEqual(self.judged()[0], [])
        for text in ("// The law of the starts.\n", 'refuse("the law of --start law");\n', "int look = 1;\n", "// It looks.\n",
                     "// `looks` that looks.\n", "int first_looks = 1;\n"):
            self.write("src/b.cpp", text)
            with self.subTest(text):
                self.assertEqual(len(self.judged()[0]), 1)

    def test_a_count_may_only_fall(self):
        self.write("include/b.hpp", "// The second alone.\n")
        self.assertIn("'alone' 2 times, 1 are recorded", self.judged()[0][0])
        self.write("include/a.hpp", "// The second.\n")
        self.write("include/b.hpp", "")
        wrong, fell = self.judged()
        self.assertEqual(wrong, [])
        self.assertEqual(len(fell), 1)
        self.assertIn("lower the record", fell[0])

    def test_a_record_is_read_as_it_was_written(self):
        counts = {("docs", "so many"): 3, ("docs/results", "law"): 1}
        path = self.root / "tests/docs/words_left.txt"
        path.write_text(words.record_of(counts))
        self.assertEqual(words.recorded(path), counts)

    def test_a_page_without_the_table_is_refused(self):
        (self.root / "docs/notation.md").write_text("# Notation\n")
        with self.assertRaises(ValueError):
            words.found_in(self.root)


if __name__ == "__main__":
    unittest.main()
