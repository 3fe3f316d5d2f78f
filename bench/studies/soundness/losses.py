#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""Is a loss ever worse than another? The state's error of both on new starts, over systems, families and steps.

usage: losses.py PROGRAM FOLDER [--losses trajectory,state:1] [--systems A,B] [--families A,B] [--jobs N]

Every bundled system, every family that the system serves, and six steps an evaluation from .05 to .8 radian of
the highest frequency omega that the starts meet; errors are means over trajectories of length 200/omega. A row
where the first loss is worse by more than three standard errors of both, and by more than the factor 1.4 by
which one search differs from another, is bad; so is one where only the second gives what may be used.
Writes losses.csv, losses.md.
"""
import csv
import math
import os
import sys
from concurrent.futures import ThreadPoolExecutor

from asking import asked_for, ask, highest_frequency

RADIANS = (0.05, 0.1, 0.2, 0.35, 0.55, 0.8)
SCATTER = 1.4
ROUNDING = 1e-12  # sums of some thousand roundings: where both are there, the linear system is solved
TRAJECTORIES = 200
HORIZON = 200.0  # times 1/omega


def errors_of(program, system, family, loss, steps, horizon):
    """The rows of a comparison, or why it was refused."""
    found, code, said = ask(program, "compare", "--system", system, "--methods", f"learned:{family}", "--equal-cost",
                            "--steps", ",".join(map(repr, steps)), "--horizon", repr(horizon), "--metric", "state",
                            "--trajectories", TRAJECTORIES, "--learn-loss", loss, "--threads", 1)
    if found is None:
        return {}, said.splitlines()[-1] if said else f"exit code {code}"
    return {row["step"]: row for row in found["rows"]}, ""


def row_of(system, family, step, ours, theirs, why):
    def number(row, key):
        value = row.get(key) if row else None
        return math.nan if value is None else value

    error, other = number(ours, "error"), number(theirs, "error")
    spread = 3.0 * math.hypot(number(ours, "standard_error"), number(theirs, "standard_error"))
    if math.isnan(error):
        is_bad = not math.isnan(other)
    else:
        is_bad = error > ROUNDING and error > SCATTER * other and error > other + spread
    return {"system": system, "family": family, "step": step, "error": error, "other": other, "ratio": other / error,
            "bad": int(is_bad), "reason": why}


def main():
    asked = asked_for(__doc__, "families", losses="trajectory,state:1")
    first, second = asked.losses.split(",")
    listed, _, _ = ask(asked.program, "list")
    families = asked.families.split(",") if asked.families else [one["name"] for one in listed["families"]]
    cases = []
    for system in asked.systems.split(","):
        omega = highest_frequency(asked.program, "--system", system)
        steps = [float(f"{angle / omega:.3g}") for angle in RADIANS]
        cases += [(system, family, steps, HORIZON / omega) for family in families]

    def rows_of(case):
        system, family, steps, horizon = case
        ours, why = errors_of(asked.program, system, family, first, steps, horizon)
        theirs, _ = errors_of(asked.program, system, family, second, steps, horizon)
        if sys.stderr.isatty():
            print(f"\r{system} {family}    ", end="", file=sys.stderr)
        return [row_of(system, family, step, ours.get(step), theirs.get(step), why) for step in steps]

    rows = []
    with ThreadPoolExecutor(asked.jobs) as pool:
        for some in pool.map(rows_of, cases):
            rows += some
            write(asked.folder, rows, first, second)
    both = sorted(row["ratio"] for row in rows if not math.isnan(row["ratio"]))
    bad = sum(row["bad"] for row in rows)
    if both:
        print(f"{len(rows)} rows, {len(both)} with both errors: {second} over {first} from {both[0]:.3g} to "
              f"{both[-1]:.3g}, median {both[len(both) // 2]:.3g}; {bad} bad")
    return 1 if bad or not both else 0


def write(folder, rows, first, second):
    with open(os.path.join(folder, "losses.csv"), "w", newline="", encoding="utf-8") as file:
        table = csv.DictWriter(file, rows[0].keys())
        table.writeheader()
        table.writerows(rows)
    with open(os.path.join(folder, "losses.md"), "w", encoding="utf-8") as file:
        print(f"| system | family | step an evaluation | {first} | {second} | ratio | |\n|---|---|---|---|---|---|---|",
              file=file)
        for row in rows:
            print(f"| {row['system']} | {row['family']} | {row['step']:g} | {row['error']:.2e} | {row['other']:.2e} | "
                  f"{row['ratio']:.3g} | {'bad' if row['bad'] else row['reason']} |", file=file)


if __name__ == "__main__":
    sys.exit(main())
