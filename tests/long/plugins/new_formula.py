#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""A formula that was never compiled, by eight processes at once and by four ranks of MPI: all end well, with equal bytes.

usage: new_formula.py PROGRAM MPIEXEC FOLDER [--repetitions N]; the exit status is 1 if a promise was broken

Each repetition begins with an empty cache, which the processes make too. Beside PROGRAM is plugin.flags; formulas are
compiled without optimisation here, as the order in which processes write is what is tried. MPIEXEC may be empty.
"""
import os
import shutil
import subprocess
import sys

PROGRAM = os.path.abspath(sys.argv[1])
MPIEXEC = sys.argv[2]
FOLDER = os.path.abspath(sys.argv[3])
REPETITIONS = int(sys.argv[sys.argv.index("--repetitions") + 1]) if "--repetitions" in sys.argv else 2
PROCESSES = 8
RANKS = 4
FORMULA = ["run", "--potential", "x^2+0.0625*x^4+x^6/3", "--variables", "x", "--method", "verlet", "--step", "0.1",
           "--horizon", "1", "--trajectories", "8", "--no-checks", "--threads", "1", "--output"]


def without_optimisation():
    """A copy of the program that compiles so, or the program itself, if it has no flags."""
    flags = os.path.join(os.path.dirname(PROGRAM), "plugin.flags")
    if not os.path.exists(flags):
        return PROGRAM
    with open(flags, encoding="utf-8") as file:
        lines = ["-O0" if line.startswith("-O") else line for line in file.read().splitlines()]
    with open(os.path.join(FOLDER, "plugin.flags"), "w", encoding="utf-8") as file:
        file.write("\n".join(lines) + "\n")
    return shutil.copy(PROGRAM, FOLDER)


def begin(command):
    return subprocess.Popen(command, cwd=FOLDER, env={**os.environ, "XDG_CACHE_HOME": os.path.join(FOLDER, "cache")},
                            stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)


def outcome(begun, output, expected):
    """Why a process did not end well with the bytes expected; empty if it did."""
    said = begun.communicate()[1].strip()
    if begun.returncode != 0:
        return f"exit code {begun.returncode}: {said[:300]}"
    with open(os.path.join(FOLDER, output), "rb") as file:
        return "" if file.read() == expected else "other bytes"


def repetition(program, expected):
    """Outcomes of the processes, and of the ranks as one."""
    outputs = [f"process_{k}.csv" for k in range(PROCESSES)]
    shutil.rmtree(os.path.join(FOLDER, "cache"))
    begun = [begin([program, *FORMULA, output]) for output in outputs]
    of_processes = [outcome(one, output, expected) for one, output in zip(begun, outputs)]
    if not MPIEXEC:
        return of_processes, []
    shutil.rmtree(os.path.join(FOLDER, "cache"))
    ranks = begin([MPIEXEC, "--oversubscribe", "--bind-to", "none", "-n", str(RANKS), program, *FORMULA, "ranks.csv"])
    return of_processes, [outcome(ranks, "ranks.csv", expected)]


def main():
    shutil.rmtree(FOLDER, ignore_errors=True)
    os.makedirs(os.path.join(FOLDER, "cache"))
    program = without_optimisation()
    alone = begin([program, *FORMULA, "alone.csv"])
    assert alone.wait() == 0, alone.stderr.read()
    with open(os.path.join(FOLDER, "alone.csv"), "rb") as file:
        expected = file.read()
    counts = {"processes": [0, 0], "runs of ranks": [0, 0]}
    for number in range(REPETITIONS):
        for kind, outcomes in zip(counts, repetition(program, expected)):
            for why in outcomes:
                counts[kind][0] += why == ""
                counts[kind][1] += 1
                if why:
                    print(f"repetition {number + 1}, {kind}: {why}", file=sys.stderr, flush=True)
        shown = [f"{good} of {all_of_them} {kind}" for kind, (good, all_of_them) in counts.items()]
        print(f"repetition {number + 1}: {', '.join(shown)} ended well so far, with equal bytes", flush=True)
    return any(good != all_of_them for good, all_of_them in counts.values())


if __name__ == "__main__":
    sys.exit(main())
