# SPDX-License-Identifier: BSL-1.0
"""The glossary of docs/notation.md: a term that a page links is defined, and what is defined is used.

Tier 1: tests/docs/links_test.py has the links.
A page links a term as `[lane](notation.md#machinery)`: to the section with the term, whose name is the text of the link.
"""
import re
import sys
import tempfile
import unittest
from collections import Counter
from pathlib import Path

root = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(root / "docs" / "site"))
import markdown

sources = {"include": (".hpp",), "src": (".hpp", ".cpp"), "docs": (".md",)}


def sections(page):
    """{anchor: (terms, names in code)} of the tables of the section `Glossary`."""
    glossary = re.search(r"^## Glossary\n(.*?)(?=^## |\Z)", page, re.DOTALL | re.MULTILINE)[1]
    found = {}
    for section in re.split(r"^### ", glossary, flags=re.MULTILINE)[1:]:
        rows = [row for row in re.findall(r"^\| ([^|]+?) \| (.*) \|$", section, re.MULTILINE) if row[0] != "term"]
        names = [name for _, meaning in rows for name in re.findall(r"`([a-z_]+)`", meaning)]
        found[markdown.slug(section.split("\n")[0])] = ([term for term, _ in rows], names)
    return found


def forms(term):
    """What is the term in a text, with its usual endings and in names."""
    words_of_it = r"(?:[\s_-]|///?|\*)+".join(map(re.escape, re.split("[ -]", term)))
    return re.compile(rf"(?i)(?<![a-z]){words_of_it}(?:e?s|e?d|t?ed|t?ing)?(?![a-z])")


def mistakes(folder):
    notation = folder / "docs/notation.md"
    known = sections(notation.read_text())
    terms = [term for terms, _ in known.values() for term in terms]
    found = [f"'{term}' is defined {count} times" for term, count in Counter(terms).items() if count > 1]
    for page in markdown.documents(folder):
        for line, is_code in markdown.lines_with_code(page.read_text()):
            for link in [] if is_code else markdown.link.finditer(line):
                address, _, anchor = link.group(3).partition("#")
                target = (page.parent / address).resolve() if address else page
                if target != notation or anchor not in known or page == notation:
                    continue
                if not any(forms(term).fullmatch(markdown.plain(link.group(2))) for term in known[anchor][0]):
                    found.append(f"{page.relative_to(folder)}: '{link.group(2)}' is no term of docs/notation.md#{anchor}")
    text = "\n".join(file.read_text() for name, suffixes in sources.items() for file in sorted((folder / name).rglob("*"))
                     if file.suffix in suffixes and file != notation)
    found += [f"'{term}' of the glossary is used nowhere" for term in terms if not forms(term).search(text)]
    text += notation.read_text()  # where code is named twice
    names = {name for _, names in known.values() for name in names}
    return found + [f"`{name}` of the glossary is no name of ours" for name in sorted(names)
                    if len(re.findall(rf"(?<![a-z]){name}(?![a-z])", text)) < 2]


class Glossary(unittest.TestCase):
    def test_of_the_project_has_no_mistake(self):
        self.assertEqual(mistakes(root), [])
        known = sections((root / "docs/notation.md").read_text())
        self.assertGreaterEqual(sum(len(terms) for terms, _ in known.values()), 80)
        links = [link for page in markdown.documents(root) for link in markdown.links(page.read_text())]
        self.assertGreaterEqual(sum(link.endswith(tuple(f"notation.md#{anchor}" for anchor in known)) for link in links), 10)

    def test_of_a_folder_with_a_mistake_is_told(self):
        sound = {
            "docs/notation.md": "# Notation\n\n## Glossary\n\n### Machinery\n\n| term | meaning |\n|---|---|\n"
                                "| lane | one element |\n| gradient kick | a flow, `rank_of` in names |\n\n"
                                "## Letters\n\n| G | gradient kick |\n",
            "docs/page.md": "# Page\n\n[lanes](notation.md#machinery) and [the lane letters](notation.md#letters).\n",
            "include/a.hpp": "/// A gradient\n/// kick on lanes.\nint rank_of(int thing);\n"}
        no_term = "docs/page.md: '{}' is no term of docs/notation.md#machinery"
        for name, old, new, *wrong in (
                ("docs/page.md", "", ""),
                ("docs/page.md", "lanes", "phantom step", no_term.format("phantom step")),
                ("docs/page.md", "lanes", "the\nlane list", no_term.format("the lane list")),
                ("docs/page.md", "lanes", "thing", no_term.format("thing")),
                ("docs/notation.md", "| lane |", "| vector element |", no_term.format("lanes"),
                 "'vector element' of the glossary is used nowhere"),
                ("docs/notation.md", "| lane |", "| gradient kick | again |\n| lane |", "'gradient kick' is defined 2 times"),
                ("docs/notation.md", "`rank_of`", "`rank_in`", "`rank_in` of the glossary is no name of ours")):
            with self.subTest(new), tempfile.TemporaryDirectory() as folder:
                for one, text in sound.items():
                    path = Path(folder).resolve() / one
                    path.parent.mkdir(exist_ok=True)
                    path.write_text(text.replace(old, new, 1) if one == name else text)
                self.assertEqual(mistakes(Path(folder).resolve()), wrong)


if __name__ == "__main__":
    unittest.main()
