#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""Are the standard errors of learned parameters the scatter of fits to other data, wherever they are printed?

usage: errors_of_theta.py PROGRAM FOLDER [--quick] [--losses trajectory,state:1] [--cases A,B] [--seeds N] [--jobs N]

Every case is learned from N seeds [12], by both losses. The standard deviation of a parameter over the seeds that print
its error, over the root mean square of what they print, must lie between .7 and 1.4; the deviation over all seeds, those
included that withhold theirs, stands beside it. A case errs where it does not: of 12 errors that are true to the last
digit, one parameter in eight does so by chance, so the range is widened to what chance leaves in one of a thousand. A
case where fewer than a third of the seeds print is withheld; then no single error may be below a third of the deviation
over all seeds. Fits are kept in fits.csv and not learned again; --quick asks six seeds of four cases.
Writes fits.csv, errors_of_theta.csv, errors_of_theta.md.
"""
import argparse
import collections
import csv
import json
import math
import os
import statistics
import sys
from concurrent.futures import ThreadPoolExecutor, as_completed

from asking import ask

LOW, HIGH = 0.7, 1.4
FEWEST = 4  # of which a deviation is taken; of 12 seeds a third
FAR_TOO_SMALL = 3.0
Case = collections.namedtuple("Case", "name family step options")
OWN = ("--potential", "0.5*(x^2 + 400*y^2) + 0.25*x^4 + x^2*y^2", "--variables", "x,y", "--parameter",
       "deviation_q=0.3,deviation_p=0.5")
CASES = [
    Case("fpu", "nystrom", 0.02, ("--system", "fpu")),
    Case("fpu", "fg_chin", 0.05, ("--system", "fpu")),
    Case("fpu", "fg4", 0.06, ("--system", "fpu")),
    Case("henon_heiles", "fg_chin", 1, ("--system", "henon_heiles", "--horizon", 30)),
    Case("henon_heiles", "nystrom", 0.6, ("--system", "henon_heiles", "--horizon", 30)),
    Case("kepler", "fg4", 0.1, ("--system", "kepler", "--horizon", 10)),
    Case("phi4", "fg_chin", 0.3, ("--system", "phi4", "--horizon", 8)),
    Case("pendulum", "fg4", 1.2, ("--system", "pendulum", "--horizon", 30)),
    Case("kepler", "nystrom", 0.02, ("--system", "kepler", "--horizon", 2)),
    Case("lennard_jones", "nystrom", 0.03, ("--system", "lennard_jones", "--horizon", 0.6)),
    Case("linear_chain", "fg_chin", 0.5, ("--system", "linear_chain", "--horizon", 10)),
    Case("stiff and quartic, by --potential", "nystrom", 0.06, (*OWN, "--horizon", 6)),
]
QUICK = (1, 3, 6, 8)


def fit_of(program, case, loss, seed):
    """One line of fits.csv."""
    found, code, said = ask(program, "learn", *case.options, "--family", case.family, "--step", case.step, "--loss", loss,
                            "--seed", seed, "--effort", "quick", "--threads", 1)
    row = {"case": case.name, "family": case.family, "step": case.step, "loss": loss, "seed": seed}
    if found is None:
        return {**row, "parameters": "", "errors": "", "withheld": f"refused: {said.splitlines()[-1] if said else code}"}
    found = found["fits"][0]
    return {**row, "parameters": json.dumps(found["parameters"]), "errors": json.dumps(found["standard_errors"]),
            "withheld": found["standard_errors_withheld"] or ""}


def key(row):
    return tuple(str(row[name]) for name in ("case", "family", "step", "loss", "seed"))


def keep(path, rows):
    with open(path, "w", newline="", encoding="utf-8") as file:
        sheet = csv.DictWriter(file, rows[0].keys(), lineterminator="\n")
        sheet.writeheader()
        sheet.writerows(rows)


def range_of(count):
    """.7 to 1.4, widened by what chance does to the deviation of so many normal numbers, by Wilson and Hilferty."""
    freedom, z = count - 1, 3.29
    spread = 2.0 / (9.0 * freedom)
    ends = [max(1.0 - spread + sign * z * math.sqrt(spread), 0.0) ** 1.5 for sign in (-1, 1)]
    return min(LOW, ends[0]), max(HIGH, ends[1])


def judged(case, loss, fits):
    """The line of the table that some fits of one case make."""
    learned = [fit for fit in fits if fit["parameters"]]
    printed = [fit for fit in learned if not fit["withheld"]]
    row = {"case": case.name, "family": case.family, "step": case.step, "loss": loss, "fits": len(fits),
           "printed": len(printed), "ratios": "", "ratios_of_all": "", "verdict": "", "why": ""}
    reasons = collections.Counter(fit["withheld"] for fit in fits if fit["withheld"])
    row["why"] = "; ".join(f"{count}: {reason}" for reason, count in reasons.most_common(2))
    ratios, of_all, worst = [], [], 0.0
    for name in json.loads(learned[0]["parameters"]) if learned else ():
        value = lambda some: [json.loads(fit["parameters"])[name] for fit in some]
        errors = [json.loads(fit["errors"])[name] for fit in printed]
        errors = [error for error in errors if error]
        if not errors or len(learned) < 2:
            continue
        size = math.sqrt(statistics.fmean(error * error for error in errors))
        deviation = statistics.stdev(value(learned))
        of_all.append(deviation / size)
        worst = max(worst, deviation / min(errors))
        if len(printed) >= FEWEST:
            ratios.append(statistics.stdev(value(printed)) / size)
    row["ratios"] = " ".join(f"{ratio:.2f}" for ratio in ratios)
    row["ratios_of_all"] = " ".join(f"{ratio:.2f}" for ratio in of_all)
    low, high = range_of(max(len(printed), 2))
    if 3 * len(printed) < len(fits):
        row["verdict"] = "bad" if worst > FAR_TOO_SMALL else "withheld"
    elif all(LOW <= ratio <= HIGH for ratio in ratios):
        row["verdict"] = "true"
    else:
        row["verdict"] = "by chance" if all(low <= ratio <= high for ratio in ratios) else "bad"
    return row


def write(folder, rows):
    keep(os.path.join(folder, "errors_of_theta.csv"), rows)
    with open(os.path.join(folder, "errors_of_theta.md"), "w", encoding="utf-8") as file:
        print("| system | family | step | loss | fits | that print errors | scatter of these over what they print | "
              "scatter of all over that | | withheld |\n" + "|---" * 10 + "|", file=file)
        for row in rows:
            print(f"| {row['case']} | `{row['family']}` | {row['step']:g} | `{row['loss']}` | {row['fits']} | "
                  f"{row['printed']} | {row['ratios'] or '-'} | {row['ratios_of_all'] or '-'} | {row['verdict']} | "
                  f"{row['why']} |", file=file)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("folder")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--losses", default="trajectory,state:1")
    parser.add_argument("--cases")
    parser.add_argument("--seeds", type=int)
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    asked = parser.parse_args()
    os.makedirs(asked.folder, exist_ok=True)
    seeds = range(1, (asked.seeds or (6 if asked.quick else 12)) + 1)
    cases = [CASES[k] for k in QUICK] if asked.quick else CASES
    cases = [case for case in cases if not asked.cases or case.name in asked.cases.split(",")]

    path = os.path.join(asked.folder, "fits.csv")
    fits = {}
    if os.path.exists(path):
        with open(path, newline="", encoding="utf-8") as file:
            fits = {key(row): row for row in csv.DictReader(file)}
    blank = lambda case, loss, seed: {"case": case.name, "family": case.family, "step": case.step, "loss": loss, "seed": seed}
    wanted = [(case, loss, seed) for loss in asked.losses.split(",") for case in cases for seed in seeds]
    with ThreadPoolExecutor(asked.jobs) as pool:
        open_work = [pool.submit(fit_of, asked.program, *one) for one in wanted if key(blank(*one)) not in fits]
        for done in as_completed(open_work):
            fits[key(done.result())] = done.result()
            keep(path, list(fits.values()))

    rows = [judged(case, loss, [fits[key(blank(case, loss, seed))] for seed in seeds])
            for loss in asked.losses.split(",") for case in cases]
    write(asked.folder, rows)
    count = collections.Counter(row["verdict"] for row in rows)
    print(f"{len(rows)} cases: " + ", ".join(f"{number} {verdict}" for verdict, number in count.items()))
    return 1 if count["bad"] else 0


if __name__ == "__main__":
    sys.exit(main())
