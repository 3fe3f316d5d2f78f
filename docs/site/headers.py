# SPDX-License-Identifier: BSL-1.0
"""What Doxygen is given of a header: the same lines, with what our comments leave unsaid because it is plain to a reader.

- Members that a concept asks for (`order`, `dimension`, ...) need no comment: docs/site/members.txt has their sentences.
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


def without_template(head):
    """`template <...> requires(...) int f()` without what stands before the type."""
    while True:
        head = head.strip()
        if head.startswith("template"):
            opened = 0
            for i, c in enumerate(head):
                opened += (c == "<") - (c == ">" and head[i - 1] != "-")
                if c == ">" and opened == 0:
                    break
            head = head[i + 1:]
        elif re.match(r"requires\s*\(", head):
            opened = 0
            for i, c in enumerate(head):
                opened += (c == "(") - (c == ")")
                if c == ")" and opened == 0:
                    break
            head = head[i + 1:]
        elif head.startswith("[["):
            head = head[head.index("]]") + 2:]
        else:
            return head


def name_of(head):
    """What a declaration declares."""
    head = without_template(head)
    for pattern in (r"using\s+(\w+)\s*=", r"concept\s+(\w+)", r"(?:enum\s+)?(?:class|struct|enum|union)\s+(\w+)\s*[^(;]*\{",
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
    i = 0
    while i < len(lines):
        if not code[i].strip() or re.match(r"\s*(#|}|public:|private:|protected:)", code[i]) or "namespace" in code[i]:
            i += 2 if code[i].rstrip().endswith("\\") else 1
            continue
        first = i
        braces = parentheses = 0
        head = None
        text = ""
        while i < len(lines):
            for c in code[i]:
                text += c
                parentheses += (c == "(") - (c == ")")
                braces += (c == "{") - (c == "}")
                if c == "{" and braces == 1 and parentheses == 0 and head is None:
                    head = text
            text += " "
            opens_class = head and re.match(r"(class|struct|union|friend class|friend struct)\b", without_template(head))
            if opens_class and braces == 1:
                break
            if braces == 0 and parentheses == 0 and re.search(r"[;}]\s*$", code[i]):
                # `requires {...}` goes on with && or || on the next line
                if i + 1 == len(lines) or not re.match(r"\s*(&&|\|\||&&\()", code[i + 1]):
                    break
            i += 1
        yield first, min(i, len(lines) - 1), text.strip()
        i += 1


def is_table(line):
    """Whether a line of a comment is one of a table made of spaces."""
    return bool(re.match(r" {2,}\S", line) or re.match(r" ?\S.*\S {2,}\S", line))


def staged_line(line, keys, pages):
    """A line of a comment, which is text alone; keys are those of the bibliography, pages {docs/NAME.md: address}."""
    if line == " @file":
        return line
    line = re.sub(r"\bdocs/[\w/-]+\.md\b", lambda m: f"[{m.group()}]({pages[m.group()]})" if m.group() in pages else m.group(), line)
    return markdown.staged_line(line, lambda address: address, keys)


def staged_comment(lines, indent, keys, pages):
    """The lines of a `///` comment; tables in it stay as they are."""
    if re.match(r" ?[a-z]", lines[0]):
        lines = [" \x01" + lines[0].lstrip(), *lines[1:]]  # or Doxygen would begin a formula with a capital
    tables = [is_table(line) for line in lines]
    out = [line if table else staged_line(line, keys, pages) for line, table in zip(lines, tables)]
    out[0] = out[0].replace("\x01", "&zwj;")
    if not any(tables):
        return [f"{indent}///{line}" for line in out]
    for i, table in enumerate(tables):
        if table and (i == 0 or not tables[i - 1]):
            out[max(i - 1, 0)] = f"{out[i - 1]} @verbatim" if i else f" @verbatim {out[0]}"
        if table and (i + 1 == len(out) or not tables[i + 1]):
            out[i] += "\n@endverbatim" if i + 1 == len(out) else ""
            if i + 1 < len(out):
                out[i + 1] = f"@endverbatim {out[i + 1]}"
    out[0] = f"{indent}/**{out[0]}"
    out[-1] = out[-1].replace("\n@endverbatim", " @endverbatim") + " */"
    return out


def staged(text, path, members, keys=(), pages=()):
    """The header for Doxygen: as many lines, each where it was."""
    lines = text.split("\n")
    pragma = next((i for i, line in enumerate(lines) if line.startswith("#pragma once")), 0)
    if pragma:
        lines[0] = "/// @file"
        for i in range(1, pragma):
            lines[i] = re.sub(r"^//(?=\s|$)", "///", lines[i])

    shared = None  # name and comment of the declaration that ended on the line before
    for first, last, declaration in statements(text.split("\n")):
        name = name_of(declaration)
        above = first
        while above > 0 and lines[above - 1].lstrip().startswith("///"):
            above -= 1
        comment = " ".join(line.strip()[3:].strip() for line in lines[above:first])
        remark = re.search(r"([;}])\s+// (.*)$", lines[last]) if first == last else None
        if not comment and "///<" not in lines[last] and not lines[first].lstrip().startswith("/**"):
            comment = sentence_for(members, path, name)
            if not comment and declaration.endswith("= delete;"):
                reason = re.search(r";\s+// (.*)$", lines[last])
                comment = f"Refused: {reason.group(1)}." if reason else "Refused."
            if not comment and shared and shared[:2] == (first - 1, name):
                comment = shared[2]
            if not comment and remark and not lines[last].lstrip().startswith("friend"):
                comment = remark.group(2)[0].upper() + remark.group(2)[1:] + "."
            if comment:
                indent = len(lines[first]) - len(lines[first].lstrip())
                said = staged_line(comment, keys, pages)
                lines[first] = f"{' ' * indent}/** {said} */ {lines[first].lstrip()}"
        shared = (last, name, comment) if comment else None

    i = 0
    while i < len(lines):
        last = i
        while last < len(lines) and lines[last].lstrip().startswith("///") and "///<" not in lines[last]:
            last += 1
        if last > i:
            indent = lines[i][:len(lines[i]) - len(lines[i].lstrip())]
            lines[i:last] = staged_comment([line.lstrip()[3:] for line in lines[i:last]], indent, keys, pages)
        i = last + 1
    return "\n".join(lines)


def unexplained(text):
    """(line, name) of each public concept whose comment does not begin with a sentence: Doxygen does not look for it."""
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
