#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""Puts what Doxygen reads into a folder, in the form that it understands: stage.py ROOT FOLDER [--headers].

FOLDER/pages and FOLDER/include have what it reads, FOLDER/html what is copied beside the pages of the site (pictures,
data), and FOLDER/layout.xml its sidebar. With --headers only headers are staged.
"""
import re
import shutil
import sys
from pathlib import Path

import bibliography
import headers
import markdown
import sidebar

# What a page of the site shows of a source that is linked to; other files are copied.
languages = {".cpp": ".cpp", ".hpp": ".cpp", ".c": ".cpp", ".h": ".cpp", ".py": ".py"}
plain_texts = (".sh", ".txt", ".cmake", ".toml", ".cff", ".bib", "")


class Site:
    """Which file of the project is which page of the site."""

    def __init__(self, root, folder):
        self.root = root
        self.folder = folder
        self.keys = bibliography.keys((root / "docs/bibliography.bib").read_text())
        self.pages = {path: self.label(path) for path in markdown.documents(root)}
        self.shown = {}  # sources and folders that a page shows
        self.copied = set()
        self.titles = {}  # of pages without one: what the first page calls them
        index = root / "docs/README.md"
        for found in markdown.link.finditer(index.read_text()):
            self.titles.setdefault((index.parent / found.group(3)).resolve(), found.group(2))

    def label(self, path):
        """docs/results/paper.md: results-paper."""
        parts = list(path.relative_to(self.root).with_suffix("").parts)
        if parts[0] == "docs":
            parts.pop(0)
            if parts == ["README"]:
                return "index"
        return "-".join(parts).lower()

    def target(self, page, address):
        """Where a link of a page leads on the site."""
        if re.match(r"\w+:", address):
            return address
        name, _, anchor = address.partition("#")
        path = (page.parent / name).resolve() if name else page
        if path in self.pages:
            label = self.pages[path]
            return f"{label}.html" + (f"#{label}--{anchor}" if anchor else "")
        if not path.exists() or not path.is_relative_to(self.root):
            return address  # docs/site/links.py will say so
        inside = path.relative_to(self.root)
        if path / "README.md" in self.pages:
            return f"{self.pages[path / 'README.md']}.html"
        if inside.parts[0] == "include":
            return "files.html" if path.is_dir() else f"@ref {inside.relative_to('include')}"
        if path.is_dir() or path.suffix in languages or path.suffix in plain_texts:
            self.shown[path] = re.sub(r"[/.]", "-", str(inside).lower()) + ("-folder" if path.is_dir() else "")
            return f"{self.shown[path]}.html"
        self.copied.add(path)
        return str(inside)

    def write_pages(self):
        for page, label in self.pages.items():
            text = page.read_text()
            if not text.startswith("# "):
                text = f"# {self.titles.get(page, page.stem)}\n\n{text}"
            text = markdown.staged(text, label, lambda address: self.target(page, address), self.keys)
            if label == "index":
                text = text.replace("{#index}", "{#mainpage}", 1)
            write(self.folder / "pages" / f"{label}.md", text)
        done = set()
        while left := sorted(set(self.shown) - done):  # a folder shows further sources
            for path in left:
                shown = self.of_folder(path) if path.is_dir() else self.of_source(path)
                write(self.folder / "pages" / f"{self.shown[path]}.md", shown)
            done.update(left)
        for path in self.copied:
            target = self.folder / "html" / path.relative_to(self.root)
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(path, target)

    def of_source(self, path):
        """The page that shows a source."""
        language = languages.get(path.suffix, ".unparsed")
        title = f"# {path.relative_to(self.root)} {{#{self.shown[path]}}}"
        ticks = "~~~~~~~~"
        return f"{title}\n\n{ticks}{{{language}}}\n{path.read_text().rstrip()}\n{ticks}\n"

    def of_folder(self, folder):
        """The page that lists the sources of a folder."""
        lines = [f"# {folder.relative_to(self.root)}/ {{#{self.shown[folder]}}}", ""]
        for file in sorted(folder.iterdir()):
            if file.suffix in languages or file.suffix == ".sh":
                url = self.target(folder / "README.md", file.name)
                lines.append(f'- <a href="{url}">{file.name}</a>: {first_sentence(file)}')
        return "\n".join(lines) + "\n"


def first_sentence(source):
    """Of the comment that a source begins with."""
    said = []
    for line in source.read_text().splitlines():
        found = re.match(r'(?://|#(?!!)|""")\s?(.*?)(?:""")?$', line)
        if found and "SPDX" not in line:
            said.append(found.group(1))
        elif said:
            break
    said = " ".join(" ".join(said).split())
    sentence = re.match(r".*?[.:](?=\s|$)", said)
    return markdown.staged_line((sentence.group() if sentence else said).rstrip(":."), str, ()) + "."


def write(path, text):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)


def stage_headers(root, folder, keys=(), pages=()):
    """Returns how many concepts are not explained, and says which."""
    unexplained = 0
    members = headers.read_members((Path(__file__).parent / "members.txt").read_text())
    for header in sorted((root / "include").rglob("*.hpp")):
        path = header.relative_to(root)
        text = header.read_text()
        for line, concept in headers.unexplained(text):
            sentence = f"Concept {concept} has no comment that begins with a sentence."
            print(f"{path}:{line}: warning: {sentence}", file=sys.stderr)
            unexplained += 1
        inside = str(path.relative_to("include/nysalt"))
        write(folder / path, headers.staged(text, inside, members, keys, pages))
    write(folder / "pages/namespace.dox", "/** @namespace nysalt Learned symplectic integrators. */\n")
    return unexplained


def main():
    root = Path(sys.argv[1]).resolve()
    folder = Path(sys.argv[2])
    if sys.argv[3:] == ["--headers"]:
        stage_headers(root, folder)
        return 0
    shutil.rmtree(folder, ignore_errors=True)
    site = Site(root, folder)
    site.write_pages()
    write(folder / "layout.xml", sidebar.layout(site))
    pages = {str(page.relative_to(root)): f"{label}.html" for page, label in site.pages.items()}
    return 1 if stage_headers(root, folder, site.keys, pages) else 0


if __name__ == "__main__":
    sys.exit(main())
