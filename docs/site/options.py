#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""Tables of options, made from the help of the program: options.py PROGRAM --check | --update.

In docs/program.md a table stands between `<!-- options of COMMAND: GROUP; ... -->` and `<!-- end of options -->`, with the
options of these groups, or of all groups but those, but no short forms of parameters. --update writes the tables, --check says whether they differ.
"""
import re
import subprocess
import sys
from pathlib import Path

page = Path(__file__).resolve().parents[2] / "docs" / "program.md"
table = re.compile(r"(<!-- options of (\w+): (all but )?(.*?) -->\n).*?(<!-- end of options -->)", re.DOTALL)


def options(text):
    """[(group, option with what it takes, meaning)] of a help."""
    found, group = [], ""
    for line in text.splitlines():
        if re.match(r"\S.*:$", line):
            group = line[:-1].removesuffix(", more")
        elif row := re.match(r"  (--\S.*?|-h,--\S+?)(?:  +(\S.*))?$", line):
            found.append([group, row[1], row[2] or ""])
        elif found and line.startswith(" " * 32):
            found[-1][2] = f"{found[-1][2]} {line.strip()}".strip()
        elif not line.strip():
            group = ""
    return [row for row in found if row[0] and not row[0].startswith("Short forms")]


def written(text, help_of):
    """The page with its tables as they are in the help of the commands."""

    def fill(match):
        begin, command, all_but, groups, end = match.groups()
        rows = [row for row in options(help_of(command)) if (row[0] in groups.split("; ")) != bool(all_but)]
        cells = [f"| `{name}` | {meaning} |\n".replace("<", "&lt;") for _, name, meaning in rows]
        return begin + "| option | meaning |\n|---|---|\n" + "".join(cells) + end

    return table.sub(fill, text)


def main():
    program, mode = sys.argv[1:]

    def help_of(command):
        return subprocess.run([program, command, "--help-all"], capture_output=True, text=True, check=True).stdout

    text = page.read_text()
    if mode == "--update":
        page.write_text(written(text, help_of))
    elif text != written(text, help_of) or len(table.findall(text)) < 8:
        sys.exit(f"{page.name} differs from the help of the program: docs/site/options.py {program} --update")


if __name__ == "__main__":
    main()
