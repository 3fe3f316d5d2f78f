#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""Whether every link leads somewhere: links.py ROOT [SITE] [--external].

In the Markdown of the project, as a forge shows it, and in the pages of the built site: files and anchors. Every page
is listed on docs/README.md, or on a README.md that is. Links to the world outside are not followed; --external lists
them.
"""
import html
import re
import sys
from pathlib import Path
from urllib.parse import unquote

import markdown


def wrong_in_markdown(root):
    """Sentences on the links of the documents, and on paths that they name as `docs/...` or `examples/...`."""
    documents = markdown.documents(root)
    anchors = {page: {anchor for _, _, anchor in markdown.headings(page.read_text())} for page in documents}
    for page in documents:
        text = page.read_text()
        for address in markdown.links(text):
            if re.match(r"\w+:", address):
                continue
            name, _, anchor = address.partition("#")
            target = (page.parent / unquote(name)).resolve() if name else page
            if not target.is_relative_to(root) or not target.exists():
                yield f"{page.relative_to(root)}: there is no {name}"
            elif anchor and anchor not in anchors.get(target, ()):
                yield f"{page.relative_to(root)}: {target.relative_to(root)} has no heading #{anchor}"
        for name in set(re.findall(r"(?<![\w/.-])(?:docs|examples)/[\w./-]*[\w/]", text)):
            if not (root / name).exists():
                yield f"{page.relative_to(root)}: there is no {name}"


def unlisted(root):
    """Sentences on pages that neither docs/README.md nor a README.md that it lists has."""
    index = root / "docs/README.md"
    listed = {index, *linked(index)}
    for folder in [page for page in listed if page.name == "README.md" and page.exists()]:
        listed |= linked(folder)
    for page in markdown.documents(root):
        if page not in listed:
            yield f"docs/README.md does not list {page.relative_to(root)}"


def linked(page):
    return {(page.parent / address.partition("#")[0]).resolve() for address in markdown.links(page.read_text())}


class Page:
    """The links and anchors of a built page."""

    def __init__(self, text):
        self.links = {html.unescape(address) for address in re.findall(r'\s(?:href|src)="([^"]+)"', text)}
        self.anchors = set(re.findall(r'\s(?:id|name)="([^"]+)"', text))


def wrong_on_site(site, external):
    """Sentences on the links of the built pages; adds to external those that lead out."""
    pages = {path: Page(path.read_text(errors="replace")) for path in sorted(site.rglob("*.html"))}
    if not pages:
        yield f"{site} has no pages"
    exist = {}
    for path, page in pages.items():
        for address in sorted(page.links):
            if re.match(r"[a-z]+:|//", address):
                if not address.startswith("javascript:"):
                    external.add(address)
                continue
            name, _, anchor = unquote(address).partition("#")
            name = re.sub(r"\?digest=\w+$", "", name)
            target = (path.parent / name).resolve() if name else path
            if target not in exist:
                exist[target] = target.exists()
            if not exist[target]:
                yield f"{path.relative_to(site)}: there is no {name}"
            elif anchor and target in pages and anchor not in pages[target].anchors:
                yield f"{path.relative_to(site)}: {target.relative_to(site)} has no anchor #{anchor}"


def main():
    options = [option for option in sys.argv[1:] if option.startswith("--")]
    root, *site = [Path(folder).resolve() for folder in sys.argv[1:] if not folder.startswith("--")]
    external = set()
    wrong = [*wrong_in_markdown(root), *unlisted(root)]
    if site:
        wrong += wrong_on_site(site[0], external)
    for sentence in wrong:
        print(sentence, file=sys.stderr)
    if "--external" in options:
        print("\n".join(sorted(external)))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
