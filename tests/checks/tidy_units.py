#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""Translation units for clang-tidy: sources of equal flags, joined.

usage: tidy_units.py COMPILE_COMMANDS FOLDER PATH...

Reads the compile_commands.json COMPILE_COMMANDS, joins those files that are compiled with equal flags, of the files
and folders PATH, and writes the units and their own compile_commands.json to FOLDER. The headers of libraries take most
of the time of clang-tidy, and a unit of many sources reads these once. Prints the number of sources.
"""
import collections
import json
import pathlib
import shlex
import sys

AT_MOST = 16  # sources of a unit: its memory stays below 2 GB


def main():
    database, folder, *paths = map(pathlib.Path, sys.argv[1:])
    groups = collections.defaultdict(list)
    for entry in json.loads(database.read_text(encoding="utf-8")):
        source = pathlib.Path(entry["file"])
        if not any(map(source.is_relative_to, paths)):
            continue
        words = shlex.split(entry["command"])
        output = words.index("-o")
        flags = [word for word in words[:output] + words[output + 2:] if word not in ("-c", entry["file"])]
        groups[tuple(flags)].append(source)
    folder.mkdir(parents=True, exist_ok=True)
    for old in folder.glob("unit_*.cpp"):
        old.unlink()
    units = []
    for flags, files in groups.items():
        for first in range(0, len(files), AT_MOST):
            unit = folder / f"unit_{len(units)}.cpp"
            unit.write_text("".join(f'#include "{file}"\n' for file in files[first:first + AT_MOST]))
            units.append({"directory": str(folder), "file": str(unit), "arguments": [*flags, "-c", str(unit)]})
    (folder / "compile_commands.json").write_text(json.dumps(units, indent=1))
    print(sum(map(len, groups.values())))


main()
