# SPDX-License-Identifier: BSL-1.0
"""Our Markdown as Doxygen must read it to show what the forge shows."""
import re

fence = re.compile(r"^( *)(`{3,})\s*([\w+-]*)\s*$")
heading = re.compile(r"^(#{1,6}) +(.*?)(?: +#+)?$")
link = re.compile(r"(!?)\[((?:\\.|[^\[\]\\]|\[(?:\\.|[^\[\]\\])*\])*)\]\(([^()\s]*(?:\([^()\s]*\)[^()\s]*)*)\)")
code = re.compile(r"(`+)(?!`)(.+?)(?<!`)\1(?!`)")


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
    """(line, whether it is code) for each line; the lines of a fence are code."""
    end = None
    for line in text.splitlines():
        found = fence.match(line)
        if end is None and found:
            end = found.group(2)
            yield line, True
        elif end is not None:
            if line.strip() == end:
                end = None
            yield line, True
        else:
            yield line, False


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
    text = re.sub(r"(?<![\\\w])<(?=[A-Za-z/])(?!/?(?:a|b|br|code|details|em|i|img|p|sub|summary|sup)\b[^<]*>)", r"\<", text)
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
        return keep(f"{ticks}{inside}{ticks}")

    def kept_link(found):
        is_picture, text, target = found.groups()
        target = target_of(target)
        if target.startswith("@ref "):
            return keep(f"[{text}]({target})")
        if is_picture:
            alt = re.sub(r'[<>"&]', lambda m: {"<": "&lt;", ">": "&gt;", '"': "&quot;", "&": "&amp;"}[m.group()], plain(text))
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
    line = escaped(line)
    while "\x00" in line:
        line = re.sub("\x00(\\d+)\x00", lambda m: kept[int(m.group(1))], line)
    return line


def staged(text, label, target_of, keys):
    """A page for Doxygen. Its headings have anchors LABEL--ANCHOR, as Doxygen wants them unique."""
    found = headings(text)
    anchors = iter(found)
    out = []
    for line, is_code in lines_with_code(text):
        title = None if is_code else heading.match(line)
        if is_code:
            begin = fence.match(line)
            if begin and begin.group(3):
                language = {"cpp": ".cpp", "python": ".py"}.get(begin.group(3), ".unparsed")
                line = f"{begin.group(1)}{begin.group(2)}{{{language}}}"
            out.append(line)
        elif title:
            level, name, anchor = next(anchors)
            name = staged_line(name, target_of, ())
            if level == 1 and not out:
                out.append(f"# {name} {{#{label}}}")
                if label != "index" and sum(1 for below, _, _ in found if below == 2) > 3:
                    out += ["", "[TOC]"]
            elif label == "index":  # whose sections are the sidebar already
                out += [f'<h2 id="index--{anchor}">{name}</h2>', ""]
            else:
                out.append(f"{'#' * level} {name} {{#{label}--{anchor}}}")
        elif line.startswith("    ") or re.match(r"^\|?[\s:|-]+\|[\s:|-]*$", line):
            out.append(line)
        else:
            out.append(staged_line(line, target_of, keys))
    return "\n".join(out) + "\n"
