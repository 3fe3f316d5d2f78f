#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""What fits of large systems cost, and what a fit of a small one is worth there.

usage: size.py PROGRAM FOLDER [--page FILE] [--systems fpu,phi4] [--sizes 16,256,4096,10000]

At each size, in degrees of freedom: user time and peak memory of a fit to the same number of trajectories, and the
state's error on starts that no fit has seen of what was learned there, of what was learned at the usual size of the
program, and of the classical methods at the same cost. Rows that FOLDER/rows.csv holds are not
measured again. Writes rows.csv, and the page of the documentation.
"""
import argparse
import csv
import json
import os
import re
import subprocess
import sys

FAMILY = "bab6"
TRAJECTORIES = 4  # to learn from, at every size
EFFORT = "quick"
TEST_TRAJECTORIES = 8
PLAIN = ("verlet", "mclachlan2", "bcss3", "pefrl", "blanes_moan_s6", "srkn6b", "srkn11b")
FORMULAS = ("phase_fitted_mclachlan5", "phase_fitted_pefrl", "phase_fitted_chin4a")
# Option of the size, degrees of freedom of one, usual value, step of six evaluations, horizon of data and of errors.
SYSTEMS = {"fpu": ("pairs", 2, 3, 0.0888, 5.0), "phi4": ("masses", 1, 16, 0.6, 10.0)}
FIELDS = ("system", "size", "learn_seconds", "learn_megabytes", "verdict", "there", "there_error", "small",
          "small_error", "plain", "plain_error", "plain_method", "formula", "formula_error", "formula_method")
FEWEST = 256  # degrees of freedom from which cost is judged: below, what does not depend on size counts
# 1.3 and 1.7 were measured from 256 to 10^4, as residuals of 100 MB leave the cache; a part that goes with N^2 gives 39.
LIMIT = 2.0


def ask(program, *arguments):
    """The document of a command, its user time and its peak memory in megabytes."""
    read, write = os.pipe()
    with subprocess.Popen([program, *map(str, arguments), "--threads", "1", "--json"], stdout=write,
                          stderr=subprocess.DEVNULL) as process:
        os.close(write)
        with os.fdopen(read, encoding="utf-8") as answer:
            text = answer.read()
        _, _, used = os.wait4(process.pid, 0)
        process.returncode = 0
    try:
        return json.loads(text), used.ru_utime + used.ru_stime, used.ru_maxrss / 1024.0
    except json.JSONDecodeError:
        sys.exit(f"no document from: {' '.join(map(str, arguments))}")


def best(rows, methods):
    """The least error of some methods that lost no trajectory, and which has it."""
    kept = [row for row in rows if row["method"] in methods and row["error"] is not None and row["diverged"] == 0]
    return min(kept, key=lambda row: row["error"]) if kept else None


def measure(asked, system, size):
    option, each, usual, step, horizon = SYSTEMS[system]
    here = ("--system", system, f"--{option}", size // each)
    small = os.path.join(asked.folder, f"{system}_small.json")
    if not os.path.exists(small):
        ask(asked.program, "learn", "--system", system, f"--{option}", usual, "--family", FAMILY, "--step", step,
            "--output", small)
    there = os.path.join(asked.folder, f"{system}_{size}.json")
    if os.path.exists(there):
        os.remove(there)
    fit, seconds, megabytes = ask(asked.program, "learn", *here, "--family", FAMILY, "--step", step, "--horizon", horizon,
                                  "--trajectories", TRAJECTORIES, "--effort", EFFORT, "--output", there)
    methods = [small] + ([there] if os.path.exists(there) else [])
    found, _, _ = ask(asked.program, "compare", *here, "--steps", step / 6.0, "--equal-cost", "--metric", "state",
                      "--horizon", horizon, "--trajectories", TEST_TRAJECTORIES, "--methods",
                      ",".join([*methods, *PLAIN, *FORMULAS]))
    row = {"system": system, "size": size, "learn_seconds": seconds, "learn_megabytes": megabytes,
           "verdict": fit["fits"][0]["verdict"]}
    for name, among in (("there", (there,)), ("small", (small,)), ("plain", PLAIN), ("formula", FORMULAS)):
        one = best(found["rows"], among)
        row[name] = one["error"] if one else ""
        row[name + "_error"] = one["standard_error"] if one else ""
        row[name + "_method"] = one["method"] if one else ""
    return row


def with_error(row, name):
    return f"{float(row[name]):.3g} ± {float(row[name + '_error']):.1g}" if row[name] else "lost"


def write_page(path, rows):
    lines = ["# Learning at size", "",
             "What a fit costs as the system grows, and what a fit of a small one is worth at the larger one. Made by",
             "`bench/studies/soundness/size.py`; how to use it: [learn small, run large](../how-to/learn_small_run_large.md).", "",
             f"Each fit is of `{FAMILY}` to {TRAJECTORIES} trajectories with `--effort {EFFORT}` on one thread; what was "
             "learned small",
             "is the default fit of `--pairs 3` or `--masses 16`, run at each size after the trial there. Errors are of the "
             "state in the",
             f"energy norm, absolute, over {TEST_TRAJECTORIES} trajectories that no fit has seen, all methods at equal "
             "evaluations. Of more than",
             "1000 masses `phi4` declares no modes, and the norm has weights 1 there.", ""]
    for system, (option, each, _, step, horizon) in SYSTEMS.items():
        mine = [row for row in rows if row["system"] == system]
        if not mine:
            continue
        lines += [f"## {system}", "", f"Step {step} of six evaluations, horizon {horizon:g}.", "",
                  "| degrees of freedom | fit, s | μs a degree | MB | verdict | learned there | learned small | best that "
                  "knows no frequency | best formula |", "|" + "---|" * 9]
        for row in mine:
            size = int(row["size"])
            plain, formula = (f"{with_error(row, name)} `{row[name + '_method']}`" for name in ("plain", "formula"))
            lines.append(f"| {size} | {float(row['learn_seconds']):.1f} | {1e6 * float(row['learn_seconds']) / size:.0f} | "
                         f"{float(row['learn_megabytes']):.0f} | {row['verdict']} | {with_error(row, 'there')} | "
                         f"{with_error(row, 'small')} | {plain} | {formula} |")
        lines.append("")
        for first, last in growth(mine):
            lines += [f"From {first['size']} to {last['size']} degrees of freedom, "
                      f"{int(last['size']) / int(first['size']):.1f} times as many, a fit takes "
                      f"{float(last['learn_seconds']) / float(first['learn_seconds']):.1f} times the time and "
                      f"{float(last['learn_megabytes']) / float(first['learn_megabytes']):.1f} times the memory.", ""]
    with open(path, "w", encoding="utf-8") as file:
        file.write(re.sub(r"\n+$", "\n", "\n".join(lines) + "\n"))


def growth(rows):
    """The first and the last size from which cost is judged, where there are two."""
    judged = sorted((row for row in rows if int(row["size"]) >= FEWEST), key=lambda row: int(row["size"]))
    return [(judged[0], judged[-1])] if len(judged) > 1 else []


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("folder")
    parser.add_argument("--page")
    parser.add_argument("--systems", default=",".join(SYSTEMS))
    parser.add_argument("--sizes", default="16,256,4096,10000")
    asked = parser.parse_args()
    os.makedirs(asked.folder, exist_ok=True)
    table = os.path.join(asked.folder, "rows.csv")
    rows = []
    if os.path.exists(table):
        with open(table, newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
    for system in asked.systems.split(","):
        for size in map(int, asked.sizes.split(",")):
            if any(row["system"] == system and int(row["size"]) == size for row in rows):
                continue
            rows.append(measure(asked, system, size))
            with open(table, "w", newline="", encoding="utf-8") as file:
                writer = csv.DictWriter(file, FIELDS, extrasaction="ignore", lineterminator="\n")
                writer.writeheader()
                writer.writerows(rows)
    write_page(asked.page or os.path.join(asked.folder, "learning-at-size.md"), rows)
    grown = [(row[0]["system"], name) for system in SYSTEMS for row in growth([r for r in rows if r["system"] == system])
             for name in ("learn_seconds", "learn_megabytes")
             if float(row[1][name]) * int(row[0]["size"]) > LIMIT * float(row[0][name]) * int(row[1]["size"])]
    for system, name in grown:
        print(f"{system}: {name} grows faster than the size")
    return 1 if grown else 0


if __name__ == "__main__":
    sys.exit(main())
