# SPDX-License-Identifier: BSL-1.0
"""The sidebar of the site, in Doxygen's words: the sections of docs/README.md with their links, the sources that pages
show, and the C++ interface of layout.xml."""
import re
from pathlib import Path

import markdown


def xml(text):
    return text.replace("&", "&amp;").replace("<", "&lt;").replace('"', "&quot;")


def entry(title, url):
    return f'<tab type="user" visible="yes" url="{xml(url)}" title="{xml(title)}"/>'


def group(title, entries, url=None):
    page_url = f' url="{xml(url)}"' if url else ""
    return [f'<tab type="usergroup" visible="yes"{page_url} title="{xml(title)}">', *entries, "</tab>"]


def sections(text):
    """[(title, [(title, address)])] of docs/README.md: the first link of each item of its lists."""
    found = []
    for line, is_code in markdown.lines_with_code(text):
        title = markdown.heading.match(line)
        item = re.match(r" *- (?=\[)", line)
        if is_code:
            continue
        if title and len(title.group(1)) == 2:
            found.append((title.group(2), []))
        elif item and found:
            link = markdown.link.match(line, item.end())
            found[-1][1].append((markdown.plain(link.group(2)), link.group(3)))
    return found


def title_of(path):
    """That of a page; of a source none."""
    if path.suffix != ".md":
        return None
    return next((markdown.plain(title) for level, title, _ in markdown.headings(path.read_text()) if level == 1), None)


def tabs_of_link(site, index, title, address):
    """That of a folder's README.md has the pages of the folder below it, as they come there."""
    path = (index.parent / address).resolve()
    url = site.target(index, address)
    if path.name != "README.md" or path.parent == site.root or path not in site.pages:
        return [entry(title, url)]
    has_page = site.pages | site.shown
    below = {}
    for link in markdown.link.finditer(path.read_text()):
        target = (path.parent / link.group(3)).resolve()
        if target.is_relative_to(path.parent) and target in has_page:
            below.setdefault(target, title_of(target) or markdown.plain(link.group(2)))
    return group(title, [entry(name, f"{has_page[target]}.html") for target, name in below.items()], url)


def layout(site):
    """Doxygen's layout file."""
    index = site.root / "docs/README.md"
    tabs = []
    for title, links in sections(index.read_text()):
        entries = [tab for link in links for tab in tabs_of_link(site, index, *link)]
        is_a_folder = len(links) == 1 and len(entries) > 1
        tabs += entries if is_a_folder else group(title, entries)
    others = []
    for path, label in sorted(site.shown.items()):
        if not path.is_dir() and not any(f'url="{xml(label)}.html"' in tab for tab in tabs):
            others.append(entry(str(path.relative_to(site.root)), f"{label}.html"))
    tabs += group("Other sources", others)
    return (Path(__file__).parent / "layout.xml").read_text().replace("<!-- pages -->", "\n      ".join(tabs))
