# SPDX-License-Identifier: BSL-1.0
"""What is cited is in docs/bibliography.bib, and the other way round."""
import re
import tempfile
import unittest
from pathlib import Path

root = Path(__file__).resolve().parents[2]
# Files in which a key may be cited.
readers = {"include": ".hpp", "src": ".hpp .cpp", "docs": ".md", "tests": ".hpp .cpp .txt", "examples": ".hpp .cpp .py .sh",
           "bench": ".hpp .cpp", "python": ".hpp .cpp .py"}


def keys(text):
    return set(re.findall(r"^@\w+\{([\w-]+),$", text, re.M))


def cited(text, known):
    """Keys that a text names: those that look like one, and others of the .bib behind a bracket or in quotes."""
    by_year = set(re.findall(r"\b[a-z]+(?:_[a-z]+)*_(?:18|19|20)\d\d\b", text))
    return by_year | (known & set(re.findall(r"[\[\"`](\w+)\b", text)))


def mistakes(folder):
    known = keys((folder / "docs/bibliography.bib").read_text())
    files = [file for name, suffixes in readers.items() for file in (folder / name).rglob("*")
             if file.suffix in suffixes.split()] + [*folder.glob("*.md"), *folder.glob("*.cff")]
    found = []
    everywhere = set()
    for file in files:
        here = cited(file.read_text(errors="replace"), known)
        everywhere |= here
        found += [f"{file.relative_to(folder)} cites {key}, which docs/bibliography.bib does not have"
                  for key in sorted(here - known)]
    return found + [f"{key} of docs/bibliography.bib is not cited" for key in sorted(known - everywhere)]


class Bibliography(unittest.TestCase):
    def test_of_the_project_is_whole(self):
        text = (root / "docs/bibliography.bib").read_text()
        self.assertGreater(len(keys(text)), 30)
        self.assertEqual(len(re.findall("^@", text, re.M)), len(keys(text)))
        self.assertEqual(mistakes(root), [])

    def test_knows_what_is_cited(self):
        known = {"hopper_1952", "solver"}
        self.assertEqual(cited("as in [hopper_1952, table 1; knuth_1968] and solver", known), {"hopper_1952", "knuth_1968"})
        self.assertEqual(cited("by [solver]", known), {"solver"})

    def test_without_an_entry_or_a_citation_is_found(self):
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            (folder / "docs").mkdir()
            (folder / "docs/bibliography.bib").write_text("@misc{hopper_1952,\n  year = 1952\n}\n@misc{solver,\n}\n")
            page = folder / "docs/page.md"
            page.write_text("By [hopper_1952] and [solver].\n")
            self.assertEqual(mistakes(folder), [])
            page.write_text("By [hopper_1952] and [knuth_1968].\n")
            self.assertEqual(mistakes(folder), ["docs/page.md cites knuth_1968, which docs/bibliography.bib does not have",
                                                "solver of docs/bibliography.bib is not cited"])


if __name__ == "__main__":
    unittest.main()
