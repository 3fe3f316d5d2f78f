#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""docs/bibliography.md is made from docs/bibliography.bib: bibliography.py --check | --update.

--check also refuses a cited key that is not in the .bib, and an entry of it that is not cited.
"""
import re
import sys
from pathlib import Path

root = Path(__file__).resolve().parents[2]
source = root / "docs/bibliography.bib"
page = root / "docs/bibliography.md"

accents = {'"a': "ä", '"o': "ö", '"u': "ü", '"U': "Ü", '"e': "ë", '"i': "ï", "'e": "é", "'a": "á", "'i": "í",
           "'o": "ó", "'u": "ú", "`e": "è", "^o": "ô", "^i": "î", "^e": "ê"}


class Mistake(Exception):
    """Says what is wrong with the .bib."""


def plain(text):
    """BibTeX's text without its braces and commands."""
    text = re.sub(r"\\url\{([^}]*)\}", r"<\1>", text)
    text = re.sub(r"\\([\"'`^])\{?\\?([A-Za-z])\}?", lambda m: accents[m.group(1) + m.group(2)], text)
    text = text.replace("\\o", "ø").replace("$\\phi^4$", "phi^4").replace("``", "“").replace("''", "”")
    text = " ".join(re.sub(r"[{}]", "", text).replace("--", "–").split())
    if "\\" in text or "$" in text:
        raise Mistake(f"no rule for the TeX in: {text}")
    return text


def entries(text):
    """[(kind, key, {field: text})] in the order of the file."""
    found = []
    for entry in re.finditer(r"^@(\w+)\{([\w-]+),\n(.*?)^\}", text, re.M | re.S):
        field = r"^ *(\w+) *= *\{(.*?)\}(?:,?$)(?=\n *\w+ *=|\n*\Z)"
        found.append((entry.group(1), entry.group(2), dict(re.findall(field, entry.group(3), re.M | re.S))))
    if len(found) != len(re.findall(r"^@", text, re.M)):
        raise Mistake("an entry is not of the form @kind{key, ... } with the brace on a line of its own")
    return found


def keys(text):
    return {key for _, key, _ in entries(text)}


def names(authors):
    """Hairer, Ernst and Lubich, Christian: E. Hairer, C. Lubich."""
    people = []
    for person in plain(authors).split(" and "):
        if person == "others":
            people.append("others")
            continue
        last, _, first = person.partition(", ")
        if not first:
            first, _, last = person.rpartition(" ")
        initials = ["-".join(f"{part[0]}." for part in name.split("-")) for name in first.split()]
        people.append(" ".join([*initials, last]))
    return ", ".join(people).replace(", others", " and others")


def shown(fields):
    """One entry as a sentence."""
    said = [f"{names(fields['author'])}: *{plain(fields['title'])}*"]
    inside = fields.get("journal") or fields.get("booktitle") or fields.get("series")
    if inside:
        inside = plain(inside)
        if "volume" in fields:
            inside += f" {fields['volume']}"
            inside += f"({fields['number']})" if "number" in fields else ""
        said.append(inside)
    for field, words in (("edition", "edition {}"), ("publisher", "{}"), ("howpublished", "{}")):
        if field in fields:
            said.append(words.format(plain(fields[field])))
    text = ", ".join(said)
    text += f" ({fields['year']})" if "year" in fields else ""
    text += f" {plain(fields['pages'])}" if "pages" in fields else ""
    text += "."
    if "doi" in fields:
        text += f" [doi:{fields['doi']}](https://doi.org/{fields['doi'].replace('(', '%28').replace(')', '%29')})"
    if "eprint" in fields:
        text += f" [{fields['eprinttype']}:{fields['eprint']}](https://arxiv.org/abs/{fields['eprint']})"
    return text


def written(text):
    """The page."""
    out = ["# Bibliography", "",
           "The works that code and documents cite, by their keys. Made from [bibliography.bib](bibliography.bib) by",
           "`docs/site/bibliography.py --update`. How to cite nysalt itself is in [CITATION.cff](../CITATION.cff).", ""]
    for _, key, fields in sorted(entries(text), key=lambda entry: entry[1]):
        out += [f"## {key}", "", shown(fields), ""]
    return "\n".join(out[:-1]) + "\n"


def readers():
    """Files in which a key may be cited."""
    for folder, suffixes in (("include", ".hpp"), ("src", ".hpp .cpp"), ("docs", ".md"), ("tests", ".hpp .cpp"),
                             ("examples", ".hpp .cpp .py .sh"), ("bench", ".hpp .cpp"), ("python", ".hpp .cpp .py"),
                             (".", ".md .cff")):
        files = (root / folder).glob("*") if folder == "." else (root / folder).rglob("*")
        yield from (file for file in files if file.suffix in suffixes.split() and file != page)


def cited(text, known):
    """Keys that a text names: those that look like one, and others of the .bib behind a bracket or in quotes."""
    by_year = set(re.findall(r"\b[a-z]+(?:_[a-z]+)*_(?:18|19|20)\d\d\b", text))
    return by_year | (known & set(re.findall(r"[\[\"`](\w+)\b", text)))


def mistakes():
    text = source.read_text()
    known = keys(text)
    found = []
    everywhere = set()
    for file in readers():
        here = cited(file.read_text(errors="replace"), known)
        everywhere |= here
        found += [f"{file.relative_to(root)} cites {key}, which docs/bibliography.bib does not have"
                  for key in sorted(here - known)]
    found += [f"{key} of docs/bibliography.bib is not cited" for key in sorted(known - everywhere)]
    if not page.exists() or page.read_text() != written(text):
        found.append("docs/bibliography.md is not that of the .bib: python3 docs/site/bibliography.py --update")
    return found


def main():
    if sys.argv[1:] == ["--update"]:
        page.write_text(written(source.read_text()))
        return 0
    if sys.argv[1:] != ["--check"]:
        print("usage: bibliography.py --check | --update", file=sys.stderr)
        return 2
    found = mistakes()
    for sentence in found:
        print(sentence, file=sys.stderr)
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
