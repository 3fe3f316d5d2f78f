#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""Every way in which a source includes a file: the file is changed, and the program runs the new system.

usage: includes.py PROGRAM FOLDER; the exit status is 1 if a promise was broken

One source includes a file in each way. Each file defines a factor of the stiffness, 1 at first: 4 doubles the frequency,
and 1 again gives the first library from the cache. A file that the compiler does not read is no part of the system:
after its change nothing is compiled. Beside PROGRAM is plugin.flags; sources are compiled without optimisation here.
"""
import json
import os
import shutil
import subprocess
import sys

PROGRAM = os.path.abspath(sys.argv[1])
FOLDER = os.path.abspath(sys.argv[2])
CACHE = os.path.join(FOLDER, "cache")
SEARCHED = {"CPATH": os.path.join(FOLDER, "by_cpath"), "CPLUS_INCLUDE_PATH": os.path.join(FOLDER, "by_cplus")}

# The file, and the lines that include it.
WAYS = [
    ("beside.hpp", '#include "beside.hpp"'),
    ("below/folder.hpp", '#include "below/folder.hpp"'),
    ("by_cpath/angle.hpp", "#include <angle.hpp>"),
    ("by_cpath/quoted.hpp", '#include "quoted.hpp"'),
    ("by_cplus/angle_of_cplus.hpp", "#include <angle_of_cplus.hpp>"),
    ("by_cplus/quoted_of_cplus.hpp", '#include "quoted_of_cplus.hpp"'),
    ("absolute.hpp", f"#include <{FOLDER}/absolute.hpp>"),
    ("macro.hpp", '#define PART "macro.hpp"\n#include PART'),
    ("comment_before.hpp", '/**/#include "comment_before.hpp"'),
    ("comment_within.hpp", '#include/**/"comment_within.hpp"'),
    ("next_line.hpp", '#include\\\n"next_line.hpp"'),
    ("import.hpp", '#import "import.hpp"'),
    ("digraph.hpp", '%:include "digraph.hpp"'),
    ("nested.hpp", '#include "outer.hpp"'),  # which includes it
    ("with blank.hpp", '#include "with blank.hpp"'),
]
NOT_READ = [
    ("in_comment.hpp", '// #include "in_comment.hpp"'),
    ("left_out.hpp", '#if 0\n#include "left_out.hpp"\n#endif'),
    ("in_text.hpp", 'inline const char* text = "#include \\"in_text.hpp\\"";'),
]
SYSTEM = """
#include <nysalt/plugin.hpp>
struct tried {
  static constexpr int dimension = 1;
  template <class T> T potential(const nysalt::vector<T, 1>& q) const { return 0.5 * STIFFNESS * q[0] * q[0]; }
};
NYSALT_SYSTEM(tried, "a well", starts([](const tried&) {
  const nysalt::vector<double, 1> one(1.0);
  return normal_around<1>({one, one}, 0.1, 0.1);
}));
"""


def write(name, text):
    path = os.path.join(FOLDER, name)
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)


def write_factor(number, name, value):
    write(name, f"#pragma once\n#define FACTOR_{number} {value}\n")


def write_all():
    for number, (name, _) in enumerate(WAYS + NOT_READ):
        write_factor(number, name, "1.0")
    write("outer.hpp", '#include "nested.hpp"\n')
    lines = [line for _, line in WAYS + NOT_READ]
    product = "*".join(f"FACTOR_{number}" for number in range(len(WAYS)))
    write("tried.hpp", "\n".join(lines) + f"\n#define STIFFNESS ({product})\n" + SYSTEM)


def without_optimisation():
    """A copy of the program that compiles so."""
    with open(os.path.join(os.path.dirname(PROGRAM), "plugin.flags"), encoding="utf-8") as file:
        lines = ["-O0" if line.startswith("-O") else line for line in file.read().splitlines()]
    write("plugin.flags", "\n".join(lines) + "\n")
    return shutil.copy(PROGRAM, FOLDER)


def frequency(program):
    done = subprocess.run([program, "stability", "--system", "./tried.hpp", "--method", "verlet", "--step", "0.01", "--json"],
                          cwd=FOLDER, env={**os.environ, **SEARCHED, "XDG_CACHE_HOME": CACHE}, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        return done.stderr.strip()
    return json.loads(done.stdout)["judgement"]["highest_frequency"]


def libraries():
    return len([name for name in os.listdir(os.path.join(CACHE, "nysalt", "plugins")) if name.endswith(".so")])


def wrong_way(program, number, name):
    """What is wrong after a change of the file, and after it is as it was; empty if nothing is."""
    before = libraries()
    write_factor(number, name, "4.0")
    changed = frequency(program)
    write_factor(number, name, "1.0")
    again = frequency(program)
    if number >= len(WAYS):
        return "" if libraries() == before else "is compiled again after a change of what the compiler does not read"
    return "" if (changed, again) == (2.0, 1.0) else f"frequency {changed}, must be 2; then {again}, must be 1"


def main():
    shutil.rmtree(FOLDER, ignore_errors=True)
    os.makedirs(FOLDER)
    program = without_optimisation()
    write_all()
    first = frequency(program)
    assert first == 1.0, first
    wrong = 0
    for number, (name, line) in enumerate(WAYS + NOT_READ):
        if what := wrong_way(program, number, name):
            wrong += 1
            print(f"{line!r}: {what}", file=sys.stderr, flush=True)
    print(f"{len(WAYS)} ways to include a file, {len(NOT_READ)} files that are not read: {wrong} wrong")
    return wrong > 0


if __name__ == "__main__":
    sys.exit(main())
