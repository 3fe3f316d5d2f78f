# SPDX-License-Identifier: BSL-1.0
"""What Breathe is given of the headers: our comments, and for plain members those of docs/site/members.txt."""
import sys
import unittest
from pathlib import Path

root = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(root / "docs" / "site"))
import api


class Staged(unittest.TestCase):
    def test_keep_tables_and_formulas(self):
        text = "/// With\n///   a    the first\n///   b    the\n/// second\n///        of two\n/// as x < y.\nint c;"
        self.assertEqual(api.staged(text), text.replace("\n", "\n/// @code{.txt}\n", 1).replace("two", "two\n/// @endcode"))

    def test_leave_other_comments(self):
        text = "/// One.\n///\n/// Two, and\n/// - three.\nint a;  ///< as  it is\n"
        self.assertEqual(api.staged(text), text)

    def test_describe_the_file_above_the_pragma(self):
        lines = api.staged("// SPDX-License-Identifier: BSL-1.0\n// What it is.\n#pragma once\n// Not this.")
        self.assertEqual(lines.split("\n"), ["/// @file", "/// What it is.", "#pragma once", "// Not this."])


class Groups(unittest.TestCase):
    def test_have_every_public_header_and_no_other_name(self):
        headers = api.public_headers(root)
        self.assertGreater(len(headers), 80)
        self.assertEqual([path for path in headers if not api.group_of(path)], [])
        self.assertIsNone(api.group_of("none.hpp"))
        for name in " ".join(api.groups.values()).split():
            self.assertTrue((root / "include/nysalt" / (name if name.endswith("/") else f"{name}.hpp")).exists(), name)


if __name__ == "__main__":
    unittest.main()
