#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""Is the method that `recommend` names as good as the best that could have been named?

usage: advice.py PROGRAM FOLDER [--systems A,B] [--seed N] [--jobs N]

Systems, bundled ones and formulas, at a budget at which an evaluation covers .35 radian of the highest frequency. The
method that is written by `recommend --output` is compared with all classical methods and with all families that took
part, each learned by a search from everywhere on all the trajectories that `recommend` learns from. Errors are those on
1,000 trajectories at equal evaluations, of which the choice has seen the first 100. The error of the advice may be 1.3
times the least of those that hold at their step. The same question is asked of Verlet, which must
fail it somewhere: else the comparison tells nothing. Writes advice.csv and advice.md.
"""
import csv
import math
import os
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor

from asking import BUNDLED, ask, asked_for, highest_frequency

FORMULAS = {
    "quartic": "q1^4/4 + q2^4/4 + q1^2*q2^2/2",
    "morse": "(1-exp(-q1))^2 + 0.1*q2^2 + 0.3*q1*q2",
}
RADIANS = (0.35,)
TURNS = 10  # of the highest frequency: the horizon
MOST = 1.3
HOLDS = ("good", "near an edge")


def options_of(system):
    return ("--potential", FORMULAS[system], "--variables", "q1,q2") if system in FORMULAS else ("--system", system)


def errors_of(document, statistic):
    """The errors of the methods that hold at their step and lose no trajectory. What is below the reference's own error, or
    rounding, says nothing."""
    rounding = 1e-12  # of some thousand steps of numbers of order one
    return {row["method"]: max(row[statistic], row["reference_error"] or 0.0, rounding) for row in document["rows"]
            if row["reason"] is None and row["diverged"] == 0 and row[statistic] is not None
            and (row["judgement"] is None or row["judgement"]["verdict"] in HOLDS)}


def row_of(program, seed, system, angle):
    omega = highest_frequency(program, *options_of(system))
    budget, horizon = float(f"{omega / angle:.3g}"), float(f"{TURNS * 2 * math.pi / omega:.3g}")
    run = (*options_of(system), "--horizon", horizon, "--metric", "state", "--threads", 1)
    row = {"system": system, "radians": angle, "budget": budget, "horizon": horizon, "verdict": "", "advice": "",
           "best": "", "ratio": "", "ratio_of_verlet": "", "reason": ""}
    with tempfile.TemporaryDirectory() as folder:
        file = os.path.join(folder, "advice.json")
        advice, code, said = ask(program, "recommend", *run, "--budget", budget, "--seed", seed, "--output", file)
        if advice is None or code == 3:
            return dict(row, verdict="none", reason=said.splitlines()[-1] if said else "")
        named = advice["winner"] or advice["best_classical"]
        learned = [one["method"] for one in advice["rows"] if one["learned"]]
        found, _, said = ask(program, "compare", *run, "--methods", ",".join([file, "all", *learned]), "--steps", 1 / budget,
                             "--equal-cost", "--trajectories", 1000, "--seed", seed, "--learn-effort", "quick", "--force")
    row.update(verdict=advice["verdict"], advice=named)
    if found is None:
        return dict(row, reason=said.splitlines()[-1])
    # Where a mean rests on few trajectories the advice is by the quantile, and so is this.
    errors = errors_of(found, "quantile_95" if advice["judged_by"] == "quantile" else "error")
    advised = next((error for method, error in errors.items() if method == file), math.inf)
    best = min(errors, key=errors.get)
    verlet = errors.get("verlet", math.inf)
    return dict(row, best=named if best == file else best, ratio=f"{advised / errors[best]:.3g}",
                ratio_of_verlet=f"{verlet / errors[best]:.3g}")


def main():
    asked = asked_for(__doc__, "methods", seed=1)
    systems = asked.systems.split(",") + (list(FORMULAS) if asked.systems == ",".join(BUNDLED) else [])
    cases = [(system, angle) for system in systems for angle in RADIANS]
    rows = []
    with ThreadPoolExecutor(asked.jobs) as pool:
        for row in pool.map(lambda case: row_of(asked.program, int(asked.seed), *case), cases):
            rows.append(row)
            write(asked.folder, rows)
    worse = [row for row in rows if row["ratio"] and not float(row["ratio"]) <= MOST]
    told = any(row["ratio"] and not float(row["ratio_of_verlet"]) <= MOST for row in rows)
    print(f"{len(rows)} advices, {len(worse)} more than {MOST} times the least error"
          + ("" if told else "; Verlet, too, is as good everywhere: the comparison tells nothing"))
    return 1 if worse or not told else 0


def write(folder, rows):
    with open(os.path.join(folder, "advice.csv"), "w", newline="", encoding="utf-8") as file:
        sheet = csv.DictWriter(file, rows[0].keys(), lineterminator="\n")
        sheet.writeheader()
        sheet.writerows(rows)
    with open(os.path.join(folder, "advice.md"), "w", encoding="utf-8") as file:
        file.write("# Advice against the best that could have been named\n\nMade by `bench/studies/soundness/advice.py`: errors on "
                   f"1,000 trajectories. At most {MOST} is asked of the ratio.\n\n")
        names = list(rows[0])
        file.write("| " + " | ".join(name.replace("_", " ") for name in names) + " |\n|" + "---|" * len(names) + "\n")
        for row in rows:
            file.write("| " + " | ".join(str(row[name]) for name in names) + " |\n")


if __name__ == "__main__":
    sys.exit(main())
