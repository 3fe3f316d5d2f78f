#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""What the tests cost: the slowest, what was left out, and each folder against tests/budget.txt.

usage: budget.py BUILD REPORT [--whole]

BUILD is a build folder, REPORT the JUnit report of its ctest. With --whole all of tier 1 was run, and a folder above the
budget, a test or a unit above its limit is named; the exit status is then 1 where CI is set, as on a person's machine
other work may have slowed the tests. Seconds are scaled by a yardstick, the compilation of a header that is of other
libraries alone, as machines differ.
"""
import os
import pathlib
import re
import sys
import xml.etree.ElementTree

COMPILE_ROOM, RUN_ROOM = 1.25, 2.0  # CPU-seconds vary by a tenth from run to run, seconds by the clock by two thirds
LEAST = 5.0  # seconds: what a folder may be above its budget in any case, as small ones vary by more
LONGEST_TEST, LONGEST_UNIT, LARGEST_UNIT = 30.0, 30.0, 1500.0  # seconds by the clock, CPU-seconds, MB
SLOWEST = 10


def read_budget(path):
    """{folder: (compile, run)} and the seconds of the yardstick."""
    budget, yardstick = {}, None
    for line in path.read_text().splitlines():
        words = line.split("#")[0].split()
        if len(words) == 2 and words[0] == "yardstick":
            yardstick = float(words[1])
        elif words:
            budget[words[0]] = (float(words[1]), float(words[2]))
    return budget, yardstick


def read_units(path):
    """{object: (CPU-seconds, MB)}; of several compilations the last."""
    units = {}
    for line in path.read_text().splitlines():
        name, seconds, megabytes = line.split()
        units[name] = (float(seconds), float(megabytes))
    return units


def target_of(unit):
    return next(part[:-4] for part in pathlib.Path(unit).parts if part.endswith(".dir"))


def folder_of(name, folders):
    """The longest folder whose tests begin like this one: learning_search_test is of learning."""
    fitting = [folder for folder in folders if name == folder or name.startswith(folder.replace("/", "_") + "_")]
    return max(fitting, key=len, default="others")


def main():
    build, report, *whole = sys.argv[1:]
    tests = {case.get("name"): float(case.get("time"))
             for case in xml.etree.ElementTree.parse(report).getroot().iter("testcase")}
    slowest = sorted(tests.items(), key=lambda one: -one[1])[:SLOWEST]
    print("-- the slowest, in seconds: " + ", ".join(f"{name} {seconds:.1f}" for name, seconds in slowest))
    if whole != ["--whole"]:
        return 0

    budget, reference = read_budget(pathlib.Path(__file__).parent.parent / "budget.txt")
    units = read_units(pathlib.Path(build, "tests/compile_costs.txt"))
    rulers = [seconds for unit, (seconds, _) in units.items()
              if unit.endswith(".gch") and target_of(unit).startswith("nysalt_test_plain_")]
    scale = sum(rulers) / len(rulers) / reference if rulers else 1.0
    compiled, ran, wrong = {}, {}, []
    for unit, (seconds, megabytes) in units.items():
        target = target_of(unit)
        folder = folder_of(re.sub("^nysalt_(test_)?", "", target), budget)
        if target.startswith("long_"):
            continue
        compiled[folder] = compiled.get(folder, 0.0) + seconds / scale
        if seconds / scale > LONGEST_UNIT or megabytes > LARGEST_UNIT:
            wrong.append(f"{unit} took {seconds / scale:.0f} CPU-seconds and {megabytes:.0f} MB to compile, and may take "
                         f"{LONGEST_UNIT:.0f} and {LARGEST_UNIT:.0f}")
    for name, seconds in tests.items():
        folder = folder_of(name, budget)
        ran[folder] = ran.get(folder, 0.0) + seconds / scale
        if seconds / scale > LONGEST_TEST:
            wrong.append(f"{name} ran {seconds / scale:.1f} s, and a test of tier 1 may run {LONGEST_TEST:.0f} s")
    for folder in sorted({*compiled, *ran}):
        of_compile, of_run = budget.get(folder, (0.0, 0.0))
        for what, seconds, allowed, room in (("compile", compiled.get(folder, 0.0), of_compile, COMPILE_ROOM),
                                             ("run", ran.get(folder, 0.0), of_run, RUN_ROOM)):
            if seconds > allowed * room + LEAST:
                wrong.append(f"tests/{folder}: {what} took {seconds:.0f} s, and the budget is {allowed:.0f}")
    print(f"-- tests compiled in {sum(compiled.values()):.0f} CPU-seconds and ran for {sum(ran.values()):.0f} s together, "
          f"as a machine whose yardstick is {reference:g} s would; here it is {scale * reference:.1f}")
    for line in wrong:
        print(f"budget: {line}")
    if wrong:
        print("budget: make these cheaper, move what is long to tests/long, or raise tests/budget.txt and say why")
    return 1 if wrong and os.environ.get("CI") else 0


if __name__ == "__main__":
    sys.exit(main())
