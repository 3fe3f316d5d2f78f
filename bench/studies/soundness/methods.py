#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""Does a classical method keep its trajectories at steps that `stability` calls stable, or safe?

usage: methods.py PROGRAM FOLDER [--older PROGRAM] [--systems A,B] [--methods A,B] [--jobs N]

Every bundled system, every method without letters O that the system serves, and six steps from .3 to .95 of the last
linearly stable one; for a method whose coefficients depend on the step, of 2 s/omega for s evaluations. What is
`stable` at a step is run there, and the `safe_step` is run, from the starts and over the times of table.py.
An older program given by --older is asked the same.
Writes methods.csv, methods.md.
"""
import csv
import os
import sys
from concurrent.futures import ThreadPoolExecutor

from table import PARTS, ask, asked_for, highest_frequency, lost_of


def judged(program, system, method, step, with_safe_step):
    """What `stability` says, and how many starts are lost where it promises that none is."""
    found, code, said = ask(program, "stability", "--system", system, "--method", method, "--step", repr(step), "--force")
    if found is None:
        return {"verdict": "refused", "reason": said.splitlines()[-1] if said else f"exit code {code}"}
    row = {"verdict": "stable" if found["stable"] else "not stable"}
    if found["stable"]:
        row["lost"], row["reason"] = lost_of(program, system, step, method)
    safe = found.get("safe_step")
    if with_safe_step and safe:
        row["safe_step"] = safe
        row["lost_at_safe_step"], _ = lost_of(program, system, safe, method)
    return row


def steps_of(method, evaluations, omega):
    last = method["limit_per_evaluation"] or 2.0
    return [float(f"{part * last * evaluations / omega:.4g}") for part in PARTS]


def main():
    asked = asked_for(__doc__, "methods")
    listed, _, _ = ask(asked.program, "list")
    methods = [one for one in listed["methods"] if "O" not in one["letters"]]
    if asked.methods:
        methods = [one for one in methods if one["name"] in asked.methods.split(",")]
    known = {}
    if asked.older:
        older, _, _ = ask(asked.older, "list")
        known = {one["name"] for one in older["methods"]}

    cases = []
    for system in asked.systems.split(","):
        omega = highest_frequency(asked.program, system)
        for method in methods:
            steps = steps_of(method, method["evaluations_per_step"], omega)
            cases += [(system, method["name"], part, step) for part, step in zip(PARTS, steps)]

    def row_of(case):
        system, method, part, step = case
        row = {"system": system, "method": method, "part": part, "step": step}
        first = part == PARTS[0]
        row.update(judged(asked.program, system, method, step, first))
        if asked.older and method in known:
            older = judged(asked.older, system, method, step, first)
            row.update({"older_" + key: value for key, value in older.items()})
        return row

    with ThreadPoolExecutor(asked.jobs) as pool:
        rows = list(pool.map(row_of, cases))
    write(asked, rows)
    bad = [row for row in rows if row.get("lost", 0) != 0 or row.get("lost_at_safe_step", 0) != 0]  # None: refused
    print(f"{len(rows)} steps, {sum(row['verdict'] == 'stable' for row in rows)} stable, "
          f"{sum('safe_step' in row for row in rows)} safe ones; {len(bad)} lose a trajectory")
    return 1 if bad else 0


def write(asked, rows):
    fields = ["system", "method", "part", "step", "verdict", "lost", "safe_step", "lost_at_safe_step", "reason"]
    if asked.older:
        fields += ["older_verdict", "older_lost", "older_safe_step", "older_lost_at_safe_step"]
    with open(os.path.join(asked.folder, "methods.csv"), "w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, fields, extrasaction="ignore", lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)

    with open(os.path.join(asked.folder, "methods.md"), "w", encoding="utf-8") as file:
        def say(*cells):
            print("| " + " | ".join(map(str, cells)) + " |", file=file)

        header = ["system", "steps", "stable", "lose a trajectory", "safe steps", "lose a trajectory"]
        if asked.older:
            header += ["of the older program: stable", "lose", "safe", "lose"]
        say(*header)
        say(*["---"] * len(header))
        for system in asked.systems.split(","):
            mine = [row for row in rows if row["system"] == system]
            cells = [f"`{system}`", len(mine)]
            for prefix in ("", "older_") if asked.older else ("",):
                cells += [sum(row.get(prefix + "verdict") == "stable" for row in mine),
                          sum(bool(row.get(prefix + "lost")) for row in mine),
                          sum(prefix + "safe_step" in row for row in mine),
                          sum(bool(row.get(prefix + "lost_at_safe_step")) for row in mine)]
            say(*cells)


if __name__ == "__main__":
    sys.exit(main())
