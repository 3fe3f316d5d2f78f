#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""Code in the documents is quoted from files that are compiled or run: quote.py --check | --update [FILE...].

    <!-- quote examples/first_steps.cpp readme -->
    ```cpp
    the text between the lines `// [readme]` and `// [/readme]`, outdented
    ```

Without a name the whole file is quoted. In files where a comment begins with # the marks are `# [NAME]` and
`# [/NAME]`. A region may hold marks of others; they are left out. --update writes the fences, also one that is not
there yet; --check says which of them differ, and refuses C++, Python and CMake without a quote. Without FILE: all of
ours.
"""
import argparse
import re
import sys
from pathlib import Path

import markdown

root = Path(__file__).resolve().parents[2]

quote_line = re.compile(r"^( *)<!-- quote (\S+)(?: (\S+))? -->$")
fence_line = re.compile(r"^( *)(`{3,})(\w*)$")
mark = re.compile(r"^ *(?://|#) \[(/?)([\w-]+)\]$")
must_be_quoted = ("cpp", "c++", "python", "cmake")
languages = {".cpp": "cpp", ".hpp": "cpp", ".c": "c", ".h": "c", ".py": "python", ".sh": "sh", ".toml": "toml",
             ".json": "json", ".txt": "cmake", ".cmake": "cmake"}


class Mistake(Exception):
    """Says what is wrong with a quotation."""


def quoted(path, name):
    """The lines of a region of a file, or of the whole file, outdented by the spaces of the first."""
    try:
        lines = (root / path).read_text().splitlines()
    except OSError:
        raise Mistake(f"there is no file {path}") from None
    if name:
        ends = [[i for i, line in enumerate(lines) if (found := mark.match(line)) and found.groups() == (slash, name)]
                for slash in ("", "/")]
        if [len(end) for end in ends] != [1, 1] or ends[0][0] > ends[1][0]:
            raise Mistake(f"{path} must have one region from [{name}] to [/{name}]")
        lines = lines[ends[0][0] + 1:ends[1][0]]
    lines = [line for line in lines if not mark.match(line)]
    while lines and not lines[0].strip():
        lines.pop(0)
    while lines and not lines[-1].strip():
        lines.pop()
    if not lines:
        raise Mistake(f"nothing is quoted from {path}")
    indent = len(lines[0]) - len(lines[0].lstrip(" "))
    if any(line.strip() and line[:indent].strip() for line in lines):
        raise Mistake(f"{path}: a line of [{name}] begins left of the first")
    return [line[indent:] for line in lines]


def rewritten(text):
    """The document with every fence as it must be, and the mistakes as (line, sentence)."""
    lines = text.splitlines()
    out = []
    mistakes = []
    i = 0
    while i < len(lines):
        quote = quote_line.match(lines[i])
        if not quote and lines[i].lstrip().startswith("<!-- quote"):
            mistakes.append((i + 1, "a quote is a line `<!-- quote PATH NAME -->`"))
        if quote:
            out.append(lines[i])
            i += 1
        fence = fence_line.match(lines[i]) if i < len(lines) else None
        if not quote and not fence:
            out.append(lines[i])
            i += 1
            continue
        first = i
        body = None
        if fence:
            last = next((k for k in range(i + 1, len(lines)) if lines[k] == fence.group(1) + fence.group(2)), None)
            if last is None:
                mistakes.append((first + 1, "this fence has no end"))
                out.extend(lines[i:])
                break
            body = lines[i + 1:last]
            i = last + 1
        if quote:
            indent, path, name = quote.groups()
            language = fence.group(3) if fence else languages.get(Path(path).suffix, "text")
            try:
                right = [(indent + line).rstrip() for line in quoted(path, name)]
            except Mistake as mistake:
                mistakes.append((first, str(mistake)))
                right = body or []
            if right != body:
                what = f"what {path} has{f' at [{name}]' if name else ''}"
                mistakes.append((first + 1, f"this is not {what}" if fence else f"the fence with {what} is not there"))
            ticks = fence.group(2) if fence else "```"
            out.extend([f"{indent}{ticks}{language}", *right, f"{indent}{ticks}"])
        else:
            if fence.group(3).lower() in must_be_quoted:
                mistakes.append((first + 1, f"{fence.group(3)} without a line `<!-- quote PATH NAME -->` above it"))
            out.extend(lines[first:i])
    return "\n".join(out) + "\n", mistakes


def main():
    parser = argparse.ArgumentParser(description="Code in the documents, quoted from files that are compiled or run.")
    action = parser.add_mutually_exclusive_group(required=True)
    action.add_argument("--check", action="store_true", help="say what differs; exit code 1 if anything does")
    action.add_argument("--update", action="store_true", help="write the fences")
    parser.add_argument("files", nargs="*", type=Path, help="Markdown files (default: all of ours)")
    arguments = parser.parse_args()
    wrong = 0
    for document in arguments.files or markdown.documents(root):
        text = document.read_text()
        after, mistakes = rewritten(text)
        if arguments.update and after != text:
            document.write_text(after)
            mistakes = rewritten(after)[1]
            print(f"{document}: written")
        for line, sentence in mistakes:
            print(f"{document}:{line}: {sentence}", file=sys.stderr)
        wrong += len(mistakes)
    if wrong and arguments.check:
        print("python3 docs/site/quote.py --update brings quotations up to date", file=sys.stderr)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
