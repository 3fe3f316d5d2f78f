#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""What users pay to compile against nysalt: a table, in Markdown.

usage: table.py SOURCES FOLDER COMPILER...

FOLDER/COMPILER is a build folder that was configured with that compiler and has compile_commands.json. Each program
and header is compiled as the library is, less its warnings: CPU seconds of the quicker of two runs, and the peak of
memory. FOLDER/table.md is written. The exit status is 1 if something does not compile.
"""
import json
import pathlib
import shlex
import subprocess
import sys
import tempfile

from cost import run

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from pages import processor  # noqa: E402


def flags_of(build):
    """What the compiler is told by the build, for the sources of the library."""
    commands = json.loads((build / "compile_commands.json").read_text(encoding="utf-8"))
    words = shlex.split(next(c["command"] for c in commands if c["file"].endswith("/src/nysalt/model.cpp")))
    not_of_users = ("-W", "-fPIC", "--param", "-fconcepts")
    flags, is_file = [], False
    for word in words[1:]:
        if is_file or word in ("-o", "-c"):
            is_file = not is_file
        elif not word.startswith(not_of_users):
            flags.append(word)
    return flags


def measure(command):
    """CPU seconds and peak MB; None if it does not compile."""
    seconds, peak = [], 0.0
    for _ in range(2):
        code, run_seconds, run_peak = run(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        if code:
            subprocess.run(command, check=False)  # again, to say why
            return None
        seconds.append(run_seconds)
        peak = max(peak, run_peak)
    return min(seconds), peak


def what_to_compile(sources, folder):
    yield "the first program, examples/first_steps.cpp", sources / "examples/first_steps.cpp"
    yield "a program of only core, tests/long/consumer/core/main.cpp", sources / "tests/long/consumer/core/main.cpp"
    for system in sorted((sources / "src/program/systems").glob("*.cpp")):
        yield f"a bundled system, {system.name}", system
    for header in ("core.hpp", "nysalt.hpp", "learn.hpp", "odeint.hpp"):
        source = folder / (header.replace(".hpp", ".cpp"))
        source.write_text(f"#include <nysalt/{header}>\n", encoding="utf-8")
        yield f"the header nysalt/{header}", source


def main():
    sources, folder = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    compilers = sys.argv[3:]
    versions = [subprocess.run([c, "--version"], capture_output=True, text=True, check=True).stdout.splitlines()[0]
                for c in compilers]
    lines = ["# What it costs to compile", "",
             f"CPU seconds and peak memory in MB on {processor()}; {'; '.join(versions)}.",
             "`./dev compile` wrote this.", "",
             "| what | " + " | ".join(f"{c}, s | MB" for c in compilers) + " |",
             "|---|" + "---|---|" * len(compilers)]
    fails = False
    with tempfile.TemporaryDirectory() as scratch:
        for name, source in what_to_compile(sources, pathlib.Path(scratch)):
            cells = []
            for compiler in compilers:
                command = [compiler, *flags_of(folder / compiler), f"-I{sources}/src", "-o", f"{scratch}/made.o", "-c",
                           str(source)]
                cost = measure(command)
                fails = fails or cost is None
                cells += ["does not compile", ""] if cost is None else [f"{cost[0]:.1f}", f"{cost[1]:.0f}"]
            lines.append(f"| {name} | " + " | ".join(cells) + " |")
            print(lines[-1], file=sys.stderr)
    (folder / "table.md").write_text("\n".join(lines) + "\n", encoding="utf-8")
    sys.exit(1 if fails else 0)


if __name__ == "__main__":
    main()
