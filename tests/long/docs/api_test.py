# SPDX-License-Identifier: BSL-1.0
"""Public names have comments, by Doxygen; one without is found. Tier 1: tests/docs/api_test.py has the groups of headers."""
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

root = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(root / "docs" / "site"))
import api


@unittest.skipUnless(shutil.which("doxygen"), "needs Doxygen")
class Names(unittest.TestCase):
    def interface(self, headers):
        with tempfile.TemporaryDirectory() as folder:
            self.assertEqual(api.run_doxygen(Path(folder), headers), [])
            return api.Interface(Path(folder), headers, api.read_members((root / "docs/site/members.txt").read_text()))

    def found(self, text, path="a.hpp"):
        return sorted(self.interface({path: f"#pragma once\nnamespace nysalt {{\n{text}\n}}\n"}).undocumented)

    def test_of_the_project_have_comments(self):
        headers = {path: api.staged(text) for path, text in api.public_headers(root).items()}
        interface = self.interface(headers)
        self.assertEqual(interface.undocumented, set())
        listed = {sentence for _, sentences in interface.members for sentence in sentences.values()}
        self.assertGreater(len(listed), 50)
        self.assertEqual(listed - interface.used, set())  # or the list is too long

    def test_without_a_comment_are_found(self):
        for text, name in (("/// An a.\nstruct a {\n  int b;\n};", "Variable nysalt::a::b"), ("struct a {\n};", "Struct a"),
                           ("int f();", "Function nysalt::f"), ("using a = int;", "Typedef nysalt::a"),
                           ("enum class a { b };", "Enum nysalt::a"), ("inline int a = 1;", "Variable nysalt::a"),
                           ("template <class T>\nconcept a = true;", "Concept a"),
                           ("/// An a.\nclass a {\n public:\n  void f();\n};", "Function nysalt::a::f"),
                           ("/// Of ints.\nint f(int);\nint g();\nfloat f(float);", "Function nysalt::g"),
                           ("/// @code{.txt}\n///   a    b\n/// @endcode\ntemplate <class T>\nconcept a = true;", "Concept a")):
            with self.subTest(text):
                sentences = [sentence for _, _, sentence in self.found(text)]
                self.assertEqual(sentences[0].replace("nysalt::", ""), f"{name} has no comment".replace("nysalt::", ""))

    def test_need_none_where_it_is_plain(self):
        for text in ("/// An a.\nstruct a {\n  a();\n  ~a();\n  int b;  // of it\n};",
                     "/// An a.\nstruct a {\n private:\n  int c;\n  struct d {\n    int e;\n  };\n};",
                     "/// An a.\n///\n///   b    c\ntemplate <class T>\nconcept a = true;",
                     "/// Adds.\nint f(int);\nfloat f(float);", "namespace detail {\nint f();\n}",
                     "/// Refers.\nvoid f(const int&);\nvoid g(int&&) = delete;  // it would be gone",
                     "/// An a.\ntemplate <class T>\nstruct a {\n  explicit a(T);\n};\ntemplate <class T>\na(T) -> a<T>;"):
            with self.subTest(text):
                self.assertEqual(self.found(text), [])

    def test_of_plain_members_are_those_of_their_folder(self):
        text = "/// An a.\nstruct a {\n  int order;\n};"
        self.assertEqual((self.found(text, "families/a.hpp"), len(self.found(text, "learning/a.hpp"))), ([], 1))

    def test_are_listed_with_their_lines(self):
        with tempfile.TemporaryDirectory() as folder:
            header = Path(folder) / "include/nysalt/a.hpp"
            header.parent.mkdir(parents=True)
            header.write_text("#pragma once\nnamespace nysalt {\n/// An a:\n///   b    c\nstruct a {\n  int b;\n};\n}\n")
            command = [sys.executable, "-B", root / "docs/site/api.py", folder, f"{folder}/out", "--undocumented"]
            (Path(folder) / "out").mkdir()
            said = subprocess.run(command, capture_output=True, text=True, check=True).stdout
            self.assertEqual(said, "include/nysalt/a.hpp:6: Variable nysalt::a::b has no comment\n")


if __name__ == "__main__":
    unittest.main()
