# SPDX-License-Identifier: BSL-1.0
"""What Doxygen is given of a header: our comments, and for plain members those of docs/site/members.txt."""
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

root = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(root / "docs" / "site"))
import headers

members = headers.read_members("# Comment.\n[systems/ bath.hpp]\norder As declared.\noperator() At a place.\n")


def staged(text, path="systems/a.hpp"):
    lines = headers.staged(text, path, members, {"hopper_1952"}, {"docs/notation.md": "notation.html"}).split("\n")
    assert len(lines) == len(text.split("\n"))
    return lines


class Comments(unittest.TestCase):
    def test_stand_on_the_lines_where_they_were(self):
        found = 0
        for header in (root / "include").rglob("*.hpp"):
            staged(header.read_text())
            found += 1
        self.assertGreater(found, 100)

    def test_of_plain_members_are_those_of_their_folder(self):
        text = "struct a {\n  static constexpr int order = 2;\n  template <class T>\n  T operator()(T x) const;\n};"
        self.assertEqual(staged(text)[1], "  /** As declared. */ static constexpr int order = 2;")
        self.assertEqual(staged(text)[2], "  /** At a place. */ template <class T>")
        self.assertEqual(staged(text, "bath.hpp")[1][:8], "  /** As")
        self.assertEqual(staged(text, "flows/a.hpp"), text.split("\n"))

    def test_of_the_list_are_all_needed(self):
        project = headers.read_members((root / "docs/site/members.txt").read_text())
        left = {(places, name) for places, sentences in project for name in sentences}
        self.assertGreater(len(left), 50)
        for header in (root / "include").rglob("*.hpp"):
            inside = str(header.relative_to(root / "include/nysalt"))
            text = headers.staged(header.read_text(), inside, project)
            for places, name in list(left):
                sentence = headers.sentence_for(project, inside, name)
                if sentence and f"/** {sentence} */" in text:
                    left.discard((places, name))
        self.assertEqual(left, set())

    def test_of_their_own_come_first(self):
        text = "struct a {\n  /// Two.\n  static constexpr int order = 2;\n};"
        self.assertEqual(staged(text), text.split("\n"))

    def test_are_shared_by_overloads_right_below(self):
        lines = staged("/// Adds.\nint add(int a) {\n  return a;\n}\ndouble add(double a);\n\n"
                       "float add(float a);\nint other(int a);")
        self.assertEqual(lines[4], "/** Adds. */ double add(double a);")
        self.assertEqual(lines[6:], ["float add(float a);", "int other(int a);"])

    def test_of_deleted_overloads_say_why(self):
        lines = staged("/// Refers to x.\nvoid of(const int& x);\nvoid of(int&& x) = delete;  // it would be gone")
        self.assertEqual(lines[2], "/** Refused: it would be gone. */ void of(int&& x) = delete;  // it would be gone")

    def test_may_stand_behind_a_declaration(self):
        self.assertEqual(staged("struct a {\n  int b = 0;  // of all\n};")[1], "  /** Of all. */ int b = 0;  // of all")

    def test_describe_the_file_above_the_pragma(self):
        lines = staged("// SPDX-License-Identifier: BSL-1.0\n// What it is.\n#pragma once\n// Not this.")
        self.assertEqual(lines, ["/// @file", "/// What it is.", "#pragma once", "// Not this."])

    def test_keep_tables_and_formulas_and_link_keys_and_pages(self):
        lines = staged("/// With\n///   a    the first\n///   b    the second\n"
                       "/// as x < y in [hopper_1952], see docs/notation.md.\nint c;")
        self.assertEqual(lines[0], "/** With @verbatim")
        self.assertEqual(lines[1], "   a    the first")
        self.assertTrue(lines[3].startswith("@endverbatim  as x < y in ["))
        self.assertIn('<a href="bibliography.html#bibliography--hopper_1952">hopper_1952</a>', lines[3])
        self.assertIn('<a href="notation.html">docs/notation.md</a>', lines[3])
        self.assertIn(r"\<svg>", staged("/// The element <svg> of it.\nint c;")[0])


class Concepts(unittest.TestCase):
    def test_begin_with_a_sentence(self):
        concept = "template <class T>\nconcept A = true;\n"
        self.assertEqual(list(headers.unexplained("/// An A.\n///   a    b\n" + concept)), [])
        self.assertEqual(list(headers.unexplained(concept)), [(1, "A")])
        self.assertEqual(list(headers.unexplained("///   a    b\n/// c\n" + concept)), [(3, "A")])
        self.assertEqual(list(headers.unexplained("namespace detail {\n" + concept + "}  // namespace detail\n")), [])


@unittest.skipUnless(shutil.which("doxygen"), "needs Doxygen")
class Names(unittest.TestCase):
    def told(self, text):
        with tempfile.TemporaryDirectory() as folder:
            header = Path(folder) / "include/nysalt/a.hpp"
            header.parent.mkdir(parents=True)
            header.write_text(text)
            command = [root / "docs/site/undocumented.sh", folder]
            return subprocess.run(command, capture_output=True, text=True, check=True).stdout.splitlines()

    def test_without_a_comment_are_told(self):
        text = ("#pragma once\nnamespace nysalt {\n/// An a.\nstruct a {\n  int b;\n};\n"
                "namespace detail {\nint c();\n}\n}\n")
        sentence = "Member b (variable) of struct nysalt::a is not documented."
        self.assertEqual(self.told(text), [f"include/nysalt/a.hpp:5: warning: {sentence}"])
        self.assertEqual(self.told(text.replace("int b;", "int b;  // of it")), [])


if __name__ == "__main__":
    unittest.main()
