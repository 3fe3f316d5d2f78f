# SPDX-License-Identifier: BSL-1.0
"""What Doxygen is given of a header: the same lines, and what our comments leave unsaid as it is plain to a reader.

- Members that a concept asks for (`order`, `dimension`, ...) need no comment: members.txt has their sentences.
- An overload right below a documented one shares its comment, and a `// remark` behind a declaration is one.
- The `// lines` above `#pragma once` describe the file.
- Tables made of spaces stay tables, and [key] is a link into the bibliography.
"""
import re

import markdown

literal = re.compile(r'"(?:\\.|[^"\\])*"|\'(?:\\.|[^\'\\])\'|//.*')


def read_members(text):
    """[(places, {name: sentence})] of members.txt."""
    sections = []
    for line in text.splitlines():
        if line.startswith("["):
            sections.append((tuple(line.strip("[]").split()), {}))
        elif line and not line.startswith("#"):
            name, sentence = line.split(None, 1)
            sections[-1][1][name] = sentence
    return sections


def sentence_for(members, path, name):
    """Of a member of a header, include/nysalt/PATH; None if it needs a comment of its own."""
    for places, sentences in members:
        if any(path.startswith(place) if place.endswith("/") else path == place for place in places):
            if name in sentences:
                return sentences[name]
    return None


def behind(text, opening, closing):
    """What follows the bracket that closes the first one."""
    opened = 0
    for i, c in enumerate(text):
        opened += (c == opening) - (c == closing and text[i - 1:i + 1] != "->")
        if c == closing and opened == 0:
            return text[i + 1:].strip()
    return ""


def without_template(head):
    """`template <...> requires(...) int f()` without what precedes the type."""
    head = head.strip()
    if head.startswith("template"):
        return without_template(behind(head, "<", ">"))
    if re.match(r"requires\s*\(", head):
        return without_template(behind(head, "(", ")"))
    if head.startswith("[["):
        return without_template(head[head.index("]]") + 2:])
    return head


def name_of(head):
    """What a declaration declares."""
    head = without_template(head)
    for pattern in (r"using\s+(\w+)\s*=", r"concept\s+(\w+)", r"(?:enum\s+)?(?:class|struct|enum)\s+(\w+)\s*[^(;]*\{",
                    r"[^=]*?(operator\s*(?:\(\)|\[\]|[^\s\w(]+))\s*\("):
        found = re.match(pattern, head)
        if found:
            return found.group(1)
    before = re.split(r"[={;]", head, maxsplit=1)[0]
    found = re.search(r"(~?\w+)\s*\(", before) or re.search(r"(\w+)\s*(?:\[[^\]]*\])?\s*$", before)
    return found.group(1) if found else ""


def statements(lines):
    """(first line, last line, text) of each declaration outside of function bodies, and of each class's head."""
    code = [literal.sub(lambda m: " " if m.group().startswith("//") else '""', line) for line in lines]
    nothing = re.compile(r"\s*($|#|\}|public:|private:|protected:|.*\bnamespace\b)")
    goes_on = re.compile(r"\s*(&&|\|\|)")  # as `requires {...}` does with the next one
    i = 0
    while i < len(lines):
        if nothing.match(code[i]):
            i += 2 if code[i].endswith("\\") else 1
            continue
        first = i
        text = ""
        is_class = False
        while i < len(lines):
            text += code[i] + " "
            head, brace, _ = text.partition("{")
            is_class = brace and re.match(r"(class|struct)\b", without_template(head))
            open_braces = text.count("{") - text.count("}")
            if is_class and open_braces == 1:
                break
            if open_braces == 0 and text.count("(") == text.count(")") and re.search(r"[;}]\s*$", text):
                if not goes_on.match("".join(code[i + 1:i + 2])):
                    break
            i += 1
        yield first, min(i, len(lines) - 1), text.strip()
        i += 1


def is_table(line):
    """Whether a line of a comment is one of a table made of spaces."""
    return bool(re.match(r" {2,}\S", line) or re.match(r" ?\S.*\S {2,}\S", line))


def staged_line(line, keys, pages):
    """A line of a comment, which is only text; keys are those of the bibliography, pages {docs/NAME.md: address}."""
    if line == " @file":
        return line
    for page in set(re.findall(r"\bdocs/[\w/-]+\.md\b", line)) & set(pages):
        line = line.replace(page, f"[{page}]({pages[page]})")
    return markdown.staged_line(line, lambda address: address, keys)


def staged_comment(lines, indent, keys, pages):
    """The lines of a `///` comment; tables in it stay as they are."""
    tables = [is_table(line) for line in lines]
    out = [line if table else staged_line(line, keys, pages) for line, table in zip(lines, tables)]
    if re.match(r" ?[a-z]", lines[0]):
        out[0] = f" &zwj;{out[0].lstrip()}"  # or Doxygen would begin a formula with a capital
    if not any(tables):
        return [f"{indent}///{line}" for line in out]
    # Doxygen keeps the text between its marks as it is, in a comment of this kind without its slashes.
    begins = [i for i, table in enumerate(tables) if table and not (i and tables[i - 1])]
    ends = [i for i, table in enumerate(tables) if table and not any(tables[i + 1:i + 2])]
    for i in begins:
        if i:
            out[i - 1] += " @verbatim"
        else:
            out[i] = f" @verbatim {out[i]}"
    for i in ends:
        if i + 1 < len(out):
            out[i + 1] = f"@endverbatim {out[i + 1]}"
        else:
            out[i] += " @endverbatim"
    return [f"{indent}/**{out[0]}", *out[1:-1], f"{out[-1]} */"] if len(out) > 1 else [f"{indent}/**{out[0]} */"]


def unsaid(members, path, name, declaration, last_line, is_one_line):
    """What a declaration without a comment needs none for; None if it needs one."""
    remark = re.search(r"[;}]\s+// (.*)$", last_line)
    sentence = sentence_for(members, path, name)
    if sentence:
        return sentence
    if declaration.endswith("= delete;"):
        return f"Refused: {remark.group(1)}." if remark else "Refused."
    if remark and is_one_line and not declaration.startswith("friend"):
        return remark.group(1)[0].upper() + remark.group(1)[1:] + "."
    return None


def staged(text, path, members, keys=(), pages=()):
    """The header for Doxygen: as many lines, each where it was."""
    lines = text.split("\n")
    pragma = next((i for i, line in enumerate(lines) if line.startswith("#pragma once")), 0)
    if pragma:
        lines[0] = "/// @file"
        for i in range(1, pragma):
            lines[i] = re.sub(r"^//(?=\s|$)", "///", lines[i])

    shared = (None, None, None)  # end, name and comment of the declaration before
    for first, last, declaration in statements(text.split("\n")):
        name = name_of(declaration)
        above = first
        while above > 0 and lines[above - 1].lstrip().startswith("///"):
            above -= 1
        comment = " ".join(line.strip()[3:].strip() for line in lines[above:first])
        if not comment and "///<" not in lines[last] and not lines[first].lstrip().startswith("/**"):
            comment = unsaid(members, path, name, declaration, lines[last], first == last)
            if not comment and shared[:2] == (first - 1, name):
                comment = shared[2]
            if comment:
                said = staged_line(comment, keys, pages)
                lines[first] = re.sub(r"^ *", lambda m: f"{m.group()}/** {said} */ ", lines[first])
        shared = (last, name, comment)

    i = 0
    while i < len(lines):
        last = i
        while last < len(lines) and re.match(r" *///(?!<)", lines[last]):
            last += 1
        if last > i:
            indent = lines[i][:len(lines[i]) - len(lines[i].lstrip())]
            lines[i:last] = staged_comment([line.lstrip()[3:] for line in lines[i:last]], indent, keys, pages)
        i = last + 1
    return "\n".join(lines)


def unexplained(text):
    """(line, name) of each public concept whose comment does not begin with a sentence: Doxygen does not check."""
    lines = text.split("\n")
    for first, _, declaration in statements(lines):
        found = re.match(r"concept\s+(\w+)", without_template(declaration))
        spaces = [line for line in lines[:first] if re.match(r"(namespace detail|}  // namespace detail)", line)]
        if not found or (spaces and spaces[-1].startswith("namespace")):
            continue
        above = first
        while lines[above - 1].startswith("//"):
            above -= 1
        comment = [line for line in lines[above:first] if line.startswith("///")]
        if not comment or is_table(comment[0][3:]):
            yield first + 1, found.group(1)
