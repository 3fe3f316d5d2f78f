# SPDX-License-Identifier: BSL-1.0
"""Our Markdown as Doxygen must read it to show what the forge shows."""
import html
import re

html_tags = "a|b|br|code|details|em|i|img|p|span|sub|summary|sup"
fence = re.compile(r"^( *)(`{3,})\s*([\w+-]*)\s*$")
heading = re.compile(r"^(#{1,6}) +(.*?)(?: +#+)?$")
link = re.compile(r"(!?)\[((?:\\.|[^\[\]\\]|\[(?:\\.|[^\[\]\\])*\])*)\]\(([^()\s]*(?:\([^()\s]*\)[^()\s]*)*)\)")
code = re.compile(r"(`+)(?!`)(.+?)(?<!`)\1(?!`)")
# Code that Doxygen would take for a function of ours: CMake targets, and members of an object.
no_name_of_ours = re.compile(r"nysalt::(?:core|nysalt|learn|odeint|mpi)$|[a-z]\w*\.\w+\(")


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


def escaped(text):
    """Text, not code, without what Doxygen would take for its own."""
    text = re.sub(r"\\(?=[A-Za-z@#%\[\]|&$])", lambda m: "\\\\" if text[m.end()].isalpha() else "", text)
    text = re.sub(r"[@%](?=\w)", r"\\\g<0>", text)
    text = re.sub(r"#(?=\w)", r"\#", text)
    text = re.sub(rf"(?<![\\\w])<(?=[A-Za-z/])(?!/?(?:{html_tags})\b[^<]*>)", r"\<", text)
    return re.sub(r"(?<![-|:\\])---?(?![-|:])", lambda m: "\\" + m.group(), text)


def staged_line(line, target_of, keys):
    """One line of text; target_of(link) is where a link leads on the site, keys those of the bibliography."""
    kept = []

    def keep(piece):
        kept.append(piece)
        return f"\x00{len(kept) - 1}\x00"

    def kept_code(found):
        inside = found.group(2)
        ticks = "``" if "'" in inside and found.group(1) == "`" else found.group(1)
        if no_name_of_ours.match(inside):
            inside = f"%{inside}"
        return keep(f"{ticks}{inside}{ticks}")

    def kept_link(found):
        is_picture, text, target = found.groups()
        target = target_of(target)
        if target.startswith("@ref "):
            return keep(f"[{text}]({target})")
        if is_picture:
            alt = html.escape(plain(text), quote=False).replace('"', "&quot;")
            return keep(f'<img src="{target}" alt="{alt}"/>')
        return keep(f'<a href="{target}">') + text + keep("</a>")

    def kept_key(found):
        key = found.group()
        return keep(f'<a href="bibliography.html#bibliography--{key}">{key}</a>') if key in keys else key

    line = re.sub(r"<!--.*?-->", "", line)
    line = code.sub(kept_code, line)
    line = link.sub(kept_link, line)
    line = re.sub(r"<https?://[^>]*>", lambda m: keep(f'<a href="{m.group()[1:-1]}">{m.group()[1:-1]}</a>'), line)
    line = re.sub(r"https?://[^\s)>\]]*", lambda m: keep(m.group()), line)
    line = re.sub(r"\b[a-z]+(?:_[a-z]+)*_\d{4}\b", kept_key, line)
    for marks, tag in (("\\*\\*", "b"), ("\\*", "em")):  # Doxygen sees none that begin or end with code
        pair = rf"(?<![\w*\\]){marks}(?=[^\s*])(.*?)(?<=[^\s*\\]){marks}(?![\w*])"
        line = re.sub(pair, lambda m: keep(f"<{tag}>") + m.group(1) + keep(f"</{tag}>"), line)
    line = escaped(line)
    while "\x00" in line:
        line = re.sub("\x00(\\d+)\x00", lambda m: kept[int(m.group(1))], line)
    return line


def cells(row):
    """Of a line of a table. Doxygen would cut at an escaped | and at one in code."""
    kept = code.sub(lambda m: m.group().replace("|", "\x01"), row.strip()).replace("\\|", "\x01").strip("|")
    return [cell.strip().replace("\x01", "|") for cell in kept.split("|")]


def breakable(cell):
    """The same with its long code marked: it may go on in the next line, as the column would else be as wide as it."""
    def marked(found):
        is_long = len(found.group(2)) > 24 and re.search("[ /]", found.group(2))
        return f'<span class="long">{found.group()}</span>' if is_long else found.group()
    return code.sub(marked, cell)


def staged_table(rows, target_of, keys):
    """The lines of a table as HTML."""
    sides = [{":-": "left", "-:": "right", "::": "center"}.get(rule[0] + rule[-1]) for rule in cells(rows[1])]
    out = ['<table class="markdownTable">']
    for i, row in enumerate([rows[0], *rows[2:]]):
        out.append("<tr>")
        for cell, side in zip(cells(row), sides):
            kind = "td" if i else "th"
            align = f' align="{side}"' if side and i else ""
            out.append(f"<{kind}{align}>{staged_line(breakable(cell), target_of, keys)}</{kind}>")
        out.append("</tr>")
    return [*out, "</table>"]


def staged(text, label, target_of, keys):
    """A page for Doxygen. Its headings have anchors LABEL--ANCHOR, as Doxygen wants them unique."""
    found = headings(text)
    anchors = iter(found)
    out = []
    table = []  # the lines of the present table
    for line, is_code in [*lines_with_code(text), ("", False)]:
        if not is_code and line.startswith("|"):
            table.append(line)
            continue
        if table:
            out += staged_table(table, target_of, keys)
            table = []
        title = None if is_code else heading.match(line)
        if is_code:
            begin = fence.match(line)
            if begin and begin.group(3):
                language = {"cpp": ".cpp", "python": ".py"}.get(begin.group(3), ".unparsed")
                line = f"{begin.group(1)}{begin.group(2)}{{{language}}}"
            out.append(line)
        elif title:
            level, name, anchor = next(anchors)
            name = staged_line(code.sub(r"\2", name), target_of, ())  # Doxygen shows the marks of code in titles
            if level == 1 and not out:
                out.append(f"# {name} {{#{label}}}")
                if label != "index" and sum(1 for below, _, _ in found if below == 2) > 3:
                    out += ["", "[TOC]"]
            elif label == "index":  # whose sections are the sidebar already
                out += [f'<h2 id="index--{anchor}">{name}</h2>', ""]
            else:
                out.append(f"{'#' * level} {name} {{#{label}--{anchor}}}")
        elif line.startswith("    "):
            out.append(line)
        else:
            out.append(staged_line(line, target_of, keys))
    return "\n".join(out).rstrip("\n") + "\n"
