#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""The parts of a comparison's report.html for pages of one's own: report.md, and NAME.svg of each picture beside it.

usage: report_parts.py FOLDER
"""
import base64
import html.parser
import pathlib
import re
import sys

MARKS = {"code": "`", "strong": "**"}


class Markdown(html.parser.HTMLParser):
    """Text of a page as Markdown; pictures are links to NAME.svg."""

    def __init__(self):
        super().__init__()
        self.text = ""
        self.open = []  # elements around what is read
        self.columns = []  # of the table that is read: the rule below each head

    def handle_starttag(self, tag, attrs):
        attributes = dict(attrs)
        self.open.append(tag)
        if tag in ("h1", "h2", "h3"):
            self.text += "\n" + "#" * int(tag[1]) + " "
        elif tag in ("p", "ul", "table", "figcaption"):
            self.text += "\n"
        elif tag == "li":
            self.text += "- "
        elif tag == "pre":
            self.text += "\n```\n"
        elif tag == "figure":
            self.text += f"\n![{attributes['data-name']}]({attributes['data-name']}.svg)\n"
        elif tag == "tr":
            self.text += "|"
        elif tag in ("th", "td"):
            self.text += " "
            if tag == "th":
                self.columns.append(" ---: |" if attributes.get("class", "").startswith("n") else " --- |")
        elif tag in MARKS and "pre" not in self.open:
            self.text += MARKS[tag]

    def handle_endtag(self, tag):
        while self.open and self.open.pop() != tag:  # as <meta>, which has no end
            pass
        if tag in ("h1", "h2", "h3", "p", "li", "tr", "figcaption"):
            self.text += "\n"
        elif tag == "pre":
            self.text += "\n```\n"
        elif tag in ("th", "td"):
            self.text += " |"
        elif tag == "thead":
            self.text += "|" + "".join(self.columns) + "\n"
            self.columns = []
        elif tag in MARKS and "pre" not in self.open:
            self.text += MARKS[tag]

    def handle_data(self, data):
        if not {"head", "nav", "script"} & set(self.open) and (data.strip() or "pre" in self.open):
            self.text += data.replace("|", "\\|") if "td" in self.open else data


def main():
    folder = pathlib.Path(sys.argv[1])
    page = (folder / "report.html").read_text(encoding="utf-8")
    for name, drawn in re.findall(r'<figure data-name="([^"]+)">\s*<img src="data:image/svg\+xml;base64,([^"]*)"', page):
        (folder / f"{name}.svg").write_bytes(base64.b64decode(drawn))
    markdown = Markdown()
    markdown.feed(re.sub(r"<(nav|script|style)\b.*?</\1>", "", page, flags=re.DOTALL))
    (folder / "report.md").write_text(markdown.text.lstrip("\n"), encoding="utf-8")


if __name__ == "__main__":
    main()
