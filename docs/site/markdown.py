# SPDX-License-Identifier: BSL-1.0
"""What our Markdown has: pages, headings and links, as a forge shows them."""
import re

fence = re.compile(r"^( *)(`{3,})\s*([\w+-]*)\s*$")
heading = re.compile(r"^(#{1,6}) +(.*?)(?: +#+)?$")
link = re.compile(r"(!?)\[((?:\\.|[^\[\]\\]|\[(?:\\.|[^\[\]\\])*\])*)\]\(([^()\s]*(?:\([^()\s]*\)[^()\s]*)*)\)")
code = re.compile(r"(`+)(?!`)(.+?)(?<!`)\1(?!`)")


def documents(root):
    """The Markdown that is for readers."""
    return sorted(page for folder in (".", "examples", "python") for page in (root / folder).glob("*.md")) + sorted(
        (root / "docs").rglob("*.md"))


def plain(text):
    """Markdown of one line without its marks."""
    text = link.sub(lambda m: m.group(2), text)
    text = re.sub(r"`+", "", text)
    text = re.sub(r"\*\*?(\S(?:[^*]*\S)?)\*\*?", r"\1", text)
    return re.sub(r"\\(.)", r"\1", text)


def slug(title):
    """The anchor that a forge gives a heading."""
    return re.sub(r"[^\w\- ]", "", plain(title).strip().lower()).replace(" ", "-")


def lines_with_code(text):
    """(line, whether it is code) for each line: that of a fence is. Lines that share a link or `code` are one."""
    end = None
    unfinished = ""
    for line in text.splitlines():
        found = fence.match(line)
        if end is not None:
            if line.strip() == end:
                end = None
            yield line, True
            continue
        goes_on = line.strip() and not found and not re.match(r" *([-*+>]|\d+\.) |#|\|", line)
        if unfinished and goes_on:
            line = f"{unfinished} {line.lstrip()}"
        elif unfinished:
            yield unfinished, False
        unfinished = ""
        if found:
            end = found.group(2)
            yield line, True
        elif line.count("`") % 2 or re.search(r"\[[^\[\]|]*$", code.sub("", line)):
            unfinished = line
        else:
            yield line, False
    if unfinished:
        yield unfinished, False


def headings(text):
    """[(level, title, anchor)] of a page."""
    seen = {}
    all_of_them = []
    for line, is_code in lines_with_code(text):
        found = None if is_code else heading.match(line)
        if found:
            anchor = slug(found.group(2))
            seen[anchor] = seen.get(anchor, -1) + 1
            again = f"-{seen[anchor]}" if seen[anchor] else ""
            all_of_them.append((len(found.group(1)), found.group(2), anchor + again))
    return all_of_them


def links(text):
    """Targets of all links and pictures of a page."""
    for line, is_code in lines_with_code(text):
        if not is_code:
            for found in link.finditer(code.sub(lambda m: " " * len(m.group()), line)):
                yield found.group(3)
