#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""Do learning and comparing work with their defaults alone?

usage: defaults.py PROGRAM FOLDER [--systems A,B] [--jobs N]

Every bundled system at six steps from .05 to .9 radian of its highest frequency an evaluation, six evaluations a step:
`learn --system S --step h`, and `compare --system S --steps h --methods learned:bab6,srkn6b`. Nothing may be refused
(exit code 2); what is learned need not be usable, as such steps need not be sensible. Writes defaults.csv,
defaults.md.
"""
import csv
import os
import sys
from concurrent.futures import ThreadPoolExecutor

from asking import ask, asked_for, highest_frequency

RADIANS = (0.05, 0.1, 0.2, 0.35, 0.6, 0.9)
EVALUATIONS = 6


def row_of(program, system, angle, step):
    with_step = ("--system", system, "--threads", 1)
    fit, code, said = ask(program, "learn", *with_step, "--step", step)
    row = {"system": system, "radians": angle, "step": step, "learn": code, "verdict": "", "reason": said}
    if fit is not None:
        fit = fit["fits"][0]
        row.update(verdict=fit["verdict"], reason=fit["reason"] or "")
    found, row["compare"], said = ask(program, "compare", *with_step, "--steps", step, "--methods", "learned:bab6,srkn6b")
    rows = {one["method"]: one for one in found["rows"]} if found else {}
    for method in ("learned:bab6", "srkn6b"):
        error = rows.get(method, {}).get("error")
        row[method] = "" if error is None else f"{error:.3g}"
    row["compare_reason"] = said if found is None else rows["learned:bab6"].get("reason") or ""
    return row


def main():
    asked = asked_for(__doc__, "families")
    cases = []
    for system in asked.systems.split(","):
        omega = highest_frequency(asked.program, "--system", system)
        cases += [(system, angle, float(f"{EVALUATIONS * angle / omega:.3g}")) for angle in RADIANS]
    rows = []
    with ThreadPoolExecutor(asked.jobs) as pool:
        for row in pool.map(lambda case: row_of(asked.program, *case), cases):
            rows.append(row)
            write(asked.folder, rows)
    refused = [row for row in rows if 2 in (row["learn"], row["compare"])]
    print(f"{len(rows)} steps, {len(refused)} refused")
    return 1 if refused else 0


def write(folder, rows):
    with open(os.path.join(folder, "defaults.csv"), "w", newline="", encoding="utf-8") as file:
        sheet = csv.DictWriter(file, rows[0].keys(), lineterminator="\n")
        sheet.writeheader()
        sheet.writerows(rows)
    with open(os.path.join(folder, "defaults.md"), "w", encoding="utf-8") as file:
        print("| system | steps | usable | nothing gained | not usable | refused |\n|---|---|---|---|---|---|", file=file)
        for system in dict.fromkeys(row["system"] for row in rows):
            mine = [row for row in rows if row["system"] == system]
            count = lambda verdict: sum(row["verdict"] == verdict for row in mine)
            refused = sum(2 in (row["learn"], row["compare"]) for row in mine)
            print(f"| `{system}` | {len(mine)} | {count('usable')} | {count('nothing gained')} | {count('not usable')} "
                  f"| {refused} |", file=file)


if __name__ == "__main__":
    sys.exit(main())
