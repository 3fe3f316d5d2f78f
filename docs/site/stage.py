#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""Puts what Doxygen reads into a folder, in the form that it understands: stage.py ROOT FOLDER [--headers].

FOLDER/pages and FOLDER/include have what it reads, FOLDER/html what is copied beside the pages of the site (pictures, data), and
FOLDER/layout.xml its sidebar: the sections of docs/README.md with their links. With --headers only headers are staged.
"""
import re
import shutil
import sys
from pathlib import Path

import bibliography
import headers
import markdown

here = Path(__file__).parent
sources = {".cpp": "cpp", ".hpp": "cpp", ".c": "cpp", ".h": "cpp", ".py": "python", ".sh": "sh", ".txt": "text",
           ".cmake": "text", ".toml": "text", ".cff": "text", ".bib": "text", "": "text"}


class Site:
    """Which file of the project is which page of the site."""

    def __init__(self, root, folder):
        self.root = root
        self.folder = folder
        self.keys = bibliography.keys((root / "docs/bibliography.bib").read_text())
        self.pages = {path: self.label(path) for path in markdown.documents(root)}
        self.shown = {}  # sources that a page shows
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
        inside = path.relative_to(self.root)
        if not path.exists():
            return address  # docs/site/links.py will say so
        if path / "README.md" in self.pages:
            return f"{self.pages[path / 'README.md']}.html"
        if path.is_dir():
            return "files.html" if inside.parts[0] == "include" else f"{self.folder_page(path)}.html"
        if inside.parts[0] == "include" and path.suffix == ".hpp":
            return f"@ref {inside.relative_to('include')}"
        if path.suffix in sources:
            self.shown[path] = str(inside).replace("/", "-").replace(".", "-").lower()
            return self.shown[path] + ".html"
        self.copied.add(path)
        return str(inside)

    def folder_page(self, folder):
        """A page that lists the sources of a folder."""
        label = str(folder.relative_to(self.root)).replace("/", "-") + "-folder"
        self.shown[folder] = label
        return label

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
        while left := sorted(set(self.shown) - done):
            for path in left:
                done.add(path)
                write(self.folder / "pages" / f"{self.shown[path]}.md", self.source(path))
        for path in self.copied:
            target = self.folder / "html" / path.relative_to(self.root)
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(path, target)

    def source(self, path):
        """The page of a source, or of a folder of them."""
        inside = path.relative_to(self.root)
        if path.is_dir():
            lines = [f"# {inside}/ {{#{self.shown[path]}}}", ""]
            for file in sorted(path.iterdir()):
                if file.is_file() and file.suffix in sources and file.name != "CMakeLists.txt":
                    lines.append(f'- <a href="{self.target(path / "x.md", file.name)}">{file.name}</a>: {first_words(file)}')
            return "\n".join(lines) + "\n"
        ticks = "~~~~~~~~"
        language = {"cpp": "{.cpp}", "python": "{.py}"}.get(sources[path.suffix], "{.unparsed}")
        return f"# {inside} {{#{self.shown[path]}}}\n\n{ticks}{language}\n{path.read_text().rstrip()}\n{ticks}\n"


def first_words(source):
    """What a source says of itself in its first sentence."""
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
    members = headers.read_members((here / "members.txt").read_text())
    for header in sorted((root / "include").rglob("*.hpp")):
        path = header.relative_to(root)
        inside = str(path.relative_to("include/nysalt"))
        text = header.read_text()
        for line, concept in headers.unexplained(text):
            print(f"{path}:{line}: warning: Concept {concept} has no comment that begins with a sentence.", file=sys.stderr)
            unexplained += 1
        write(folder / path, headers.staged(text, inside, members, keys, pages))
    write(folder / "pages/namespace.dox", "/** @namespace nysalt Learned symplectic integrators. */\n")
    return unexplained


def layout(site):
    """The sidebar: each section of docs/README.md with its links, the sources that they show, and the C++ interface."""
    groups = []
    index = site.root / "docs/README.md"
    for line, is_code in markdown.lines_with_code(index.read_text()):
        title = None if is_code else markdown.heading.match(line)
        if title and len(title.group(1)) == 2:
            groups.append((title.group(2), []))
        entry = re.match(r"^ *- (\[.*)", line)
        if entry and groups and not is_code:
            found = markdown.link.match(entry.group(1))
            groups[-1][1].append((markdown.plain(found.group(2)), found.group(3)))
    tabs = []
    for title, entries in groups:
        inside = [tab for name, address in entries for tab in entry_tabs(site, index, name, address)]
        is_folder = len(entries) == 1 and inside[-1] == "</tab>"  # which is a group already
        tabs += inside if is_folder else ['<tab type="usergroup" visible="yes" title="%s">' % xml(title), *inside, "</tab>"]
    others = [(path, f"{label}.html") for path, label in sorted(site.shown.items()) if not path.is_dir()]
    tabs += ['<tab type="usergroup" visible="yes" title="Other sources">']
    tabs += [user_tab(str(path.relative_to(site.root)), url) for path, url in others if not any(xml(url) in tab for tab in tabs)]
    tabs += ["</tab>"]
    return (here / "layout.xml").read_text().replace("<!-- pages -->", "\n      ".join(tabs))


def entry_tabs(site, index, name, address):
    """One entry of the sidebar. That of a folder's README.md has the pages of its folder below it, as they come there."""
    path = (index.parent / address).resolve()
    url = site.target(index, address)
    if path.name != "README.md" or path.parent == site.root or path not in site.pages:
        return [user_tab(name, url)]
    below = {}
    for found in markdown.link.finditer(path.read_text()):
        target = (path.parent / found.group(3)).resolve()
        if target.is_relative_to(path.parent) and target in site.pages | site.shown:
            below.setdefault(target, markdown.plain(found.group(2)))
    tabs = [user_tab(title, f"{(site.pages | site.shown)[target]}.html") for target, title in below.items()]
    return ['<tab type="usergroup" visible="yes" url="%s" title="%s">' % (xml(url), xml(name)), *tabs, "</tab>"]


def user_tab(name, url):
    return '<tab type="user" visible="yes" url="%s" title="%s"/>' % (xml(url), xml(name))


def xml(text):
    return text.replace("&", "&amp;").replace("<", "&lt;").replace('"', "&quot;")


def main():
    root = Path(sys.argv[1]).resolve()
    folder = Path(sys.argv[2])
    if sys.argv[3:] == ["--headers"]:
        stage_headers(root, folder)
        return
    shutil.rmtree(folder, ignore_errors=True)
    site = Site(root, folder)
    site.write_pages()
    write(folder / "layout.xml", layout(site))
    pages = {str(page.relative_to(root)): f"{label}.html" for page, label in site.pages.items()}
    sys.exit(1 if stage_headers(root, folder, site.keys, pages) else 0)


if __name__ == "__main__":
    main()
