#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""What fits to whole trajectories gain over fits to one step, and over the best classical method, at equal cost.

usage: trajectories.py PROGRAM FOLDER [--parts errors,thresholds,other,times] [--cases A,B] [--seed N] [--jobs N]

errors: the state's error at single steps, of both losses and of the best classical method; thresholds: force
evaluations per unit time at which the state's error comes to a level; other: systems that no start or bound of the
search was chosen on; times: seconds of one core that a fit takes. A prototype of the loss `trajectory`, which shares
no code with the program, gave other numbers for the first two; a cell errs where the program is worse by more than
1.4, by which one search differs from another, and a threshold where it is more expensive by more than a tenth, or 15 % with
a processor. Errors are of 96 trajectories that no fit has seen.
Writes errors, thresholds, other, times: .csv, and trajectories.md.
"""
import argparse
import csv
import math
import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

from asking import ask, highest_frequency

TRAJECTORIES = 96
SCATTER = 1.4
HERE = os.path.dirname(os.path.abspath(__file__))
FITTED = ["s_aia2"] + ["phase_fitted_" + one for one in ("chin4a", "omelyan_fg4", "pefrl", "vefrl", "mclachlan5",
                                                         "omelyan5v", "srkn6b")]
RIVALS = ["mclachlan2", "bcss3", "pefrl", "mclachlan5", "blanes_moan_s6", "srkn6b", "srkn11b", "srkn14a", "chin4a",
          "omelyan5v", "omelyan_fg4"]

FPU = {
    "fpu_50": ("--system", "fpu", "--omega", 50, "--horizon", 10),
    "fpu_200": ("--system", "fpu", "--omega", 200, "--horizon", 10),
}
CASES = {**FPU, "henon_heiles": ("--system", "henon_heiles", "--horizon", 30),
         "phi4": ("--system", "phi4", "--masses", 8, "--horizon", 10),
         "kepler": ("--system", "kepler", "--horizon", 20)}
# Steps per force evaluation, and the prototype's errors there.
ERRORS = [
    ("fpu_50", "fg4", {0.008: 1.9e-4, 0.0195: 2.5e-3, 0.0225: 3.0e-3, 0.0255: 4.7e-3}),
    ("fpu_50", "aba6", {0.0112: 1.0e-4, 0.016: 3.1e-4, 0.0225: 3.5e-3}),
    ("fpu_50", "bab6", {0.016: 5.8e-4, 0.0255: 4.6e-3}),
    ("fpu_200", "fg4", {0.005: 1.9e-3, 0.006: 9.1e-4, 0.0072: 6.7e-4}),
    ("henon_heiles", "bab6", {0.2: 5.8e-6, 0.24: 1.9e-5, 0.28: 5.2e-5}),
    ("phi4", "fg4", {0.1: 1.3e-3, 0.14: 5.4e-3}),
    ("kepler", "bab6", {0.014: 2.1e-6, 0.018: 1.0e-5}),
]
# Families, the steps on which levels are looked for, and for each level the prototype's evaluations per unit time; of
# families with a processor the kernel's alone. No whole step lies near a multiple of pi/omega, where all words err.
THRESHOLDS = [
    ("fpu_50", "fg4", (0.02, 0.0225, 0.0255, 0.0285, 0.03), {1e-2: 34.9}),
    ("fpu_50", "aba6", (0.009, 0.0097, 0.0116, 0.0133, 0.016, 0.018, 0.0195), {1e-3: 54, 1e-4: 89}),
    ("fpu_50", "fg4+p5", (0.0125, 0.014, 0.0175, 0.019, 0.0225, 0.0255, 0.0285, 0.03), {1e-2: 33.8, 1e-3: 50, 1e-4: 71}),
    ("fpu_200", "fg4", (0.0084, 0.0092, 0.01, 0.0108, 0.0128), {1e-2: 118}),
    ("fpu_200", "fg4+p5", (0.0092, 0.01, 0.0108, 0.0128), {1e-2: 102}),
    ("henon_heiles", "bab6", (0.28, 0.32, 0.36, 0.4), {1e-4: 3.08}),
    ("henon_heiles", "fg4+p5", (0.36, 0.4, 0.44, 0.48), {1e-4: 2.3}),
    ("phi4", "fg4", (0.13, 0.145, 0.16, 0.18), {1e-2: 6.3}),
    ("phi4", "fg4+p5", (0.16, 0.175, 0.19, 0.21), {1e-2: 5.4}),
    ("kepler", "bab6", (0.021, 0.024, 0.0265, 0.029), {1e-4: 43}),
    ("kepler", "fg4+p5", (0.032, 0.035, 0.038, 0.041), {1e-4: 29}),
]
# Of classical methods, from the largest step of the families down by octaves and halves of them.
OCTAVES = 3.5
# On no one of these was anything chosen. Steps are in radians of the highest frequency.
OTHER = {
    "three_stiff": ("FPU chain, stiff frequencies 30, 50 and 70", os.path.join(HERE, "systems", "three_stiff.hpp"), 10),
    "stiff_morse": ("Morse chain, one bond 100 times stiffer", os.path.join(HERE, "systems", "stiff_morse.hpp"), 10),
    "quartic": ("Quartic oscillator in the plane", None, 20),
    "fpu_64": ("FPU chain of 64 pairs, omega = 50", None, 10),
}
OF_OTHER = {
    "quartic": ("--potential", "0.25*(x^4 + y^4) + 0.2*x^2*y^2", "--variables", "x,y", "--parameter",
                "deviation_q=0.7,deviation_p=0.7"),
    "fpu_64": ("--system", "fpu", "--pairs", 64),
}
OTHER_FAMILIES = ("bab6", "bab6_free", "aba6_free", "fg4", "fg4+p3")
RADIANS = (0.2, 0.5, 0.8, 1.2)
# Fits whose time is taken: families with their evaluations a step, and systems with a step an evaluation.
TIMED = (("fg_chin", 3), ("fg4", 4), ("aba4", 4), ("bab6", 6), ("aba6", 6), ("bab6_free", 6), ("fg4+p3", 4), ("fg4+p5", 4))
TIMES = (("fpu_50", 0.008), ("fpu_50", 0.0225), ("henon_heiles", 0.24), ("phi4", 0.1), ("kepler", 0.018))


def options_of_other(name):
    _, file, horizon = OTHER[name]
    system = OF_OTHER.get(name) or ("--system", file)
    return (*system, "--horizon", horizon)


def compare(program, options, methods, steps, seed, *more):
    """The rows of a comparison; of a refused one none, and why."""
    found, code, said = ask(program, "compare", *options, "--equal-cost", "--metric", "state", "--methods",
                            ",".join(methods), "--steps", ",".join(map(repr, steps)), "--trajectories", TRAJECTORIES,
                            "--seed", seed, "--threads", 1, *more)
    if found is None:
        return [], said.splitlines()[-1] if said else f"exit code {code}"
    return found["rows"], ""


def is_number(value):
    return value is not None and not math.isnan(value)


def number(row, key="error"):
    value = row.get(key) if row else None
    return math.nan if value is None else value


def best_of(rows, step):
    sound = [row for row in rows if row["step"] == step and is_number(row["error"]) and not row.get("diverged")]
    return min(sound, key=lambda row: row["error"], default=None)


def crossings(points, level):
    """Costs at which the error comes to the level, from dear to cheap, on lines of logarithms between steps.

    Points are (cost, error); an error that does not exist is beyond every level.
    """
    points = sorted((cost, error if is_number(error) and error > 0.0 else math.inf) for cost, error in points)[::-1]
    found = []
    for (cost, error), (next_cost, next_error) in zip(points, points[1:]):
        if (error > level) == (next_error > level):
            continue
        if math.isinf(error) or math.isinf(next_error):
            found.append(next_cost if next_error <= level else cost)
            continue
        part = math.log(level / error) / math.log(next_error / error)
        found.append(math.exp(math.log(cost) + part * math.log(next_cost / cost)))
    if points and points[-1][1] <= level:
        found.append(-points[-1][0])  # below the cheapest that was tried
    return found


def errors_of(program, case, seed):
    name, family, cells = case
    options, steps = CASES[name], list(cells)
    rivals = RIVALS + (FITTED if name != "kepler" else [])
    ours, why = compare(program, options, [f"learned:{family}", *rivals], steps, seed)
    theirs, _ = compare(program, options, [f"learned:{family}"], steps, seed, "--learn-loss", "state:1")
    rows = []
    for step in steps:
        at = lambda found: next((row for row in found if row["step"] == step and row["method"] == f"learned:{family}"), None)
        rival = best_of([row for row in ours if not row["method"].startswith("learned")], step)
        error = number(at(ours))
        rows.append({"case": name, "family": family, "step": step, "one_step": number(at(theirs)),
                     "one_step_standard_error": number(at(theirs), "standard_error"), "trajectory": error,
                     "standard_error": number(at(ours), "standard_error"), "prototype": cells[step],
                     "factor": error / cells[step], "rival": rival["method"] if rival else "none", "rival_error": number(rival),
                     "bad": int(not error <= SCATTER * cells[step]), "reason": why or (at(ours) or {}).get("reason") or ""})
    return rows


def thresholds_of(program, case, seed):
    name, family, steps, levels = case
    found, _ = compare(program, CASES[name], [f"learned:{family}"], steps, seed)
    most = 1.15 if "+p" in family else 1.1
    rows = []
    for level, goal in levels.items():
        at = crossings([(1.0 / row["step"], row["error"]) for row in found], level)
        with_looks = crossings([(row.get("evaluations_per_time") or math.inf, row["error"]) for row in found], level)
        rows.append({"case": name, "method": f"learned:{family}", "level": level, "first": at[0] if at else math.nan,
                     "last": at[-1] if at else math.nan, "charged": with_looks[-1] if with_looks else math.nan,
                     "prototype": goal, "bad": int(not at or abs(at[-1]) > most * goal)})
    return rows


def classical_thresholds_of(program, name, seed):
    """The cheapest classical method at each of the levels of a case."""
    mine = [case for case in THRESHOLDS if case[0] == name]
    largest = max(step for case in mine for step in case[2])
    steps = [float(f"{largest / 2.0 ** (half / 2):.4g}") for half in range(int(2 * OCTAVES) + 1)]
    rivals = RIVALS + (FITTED if name != "kepler" else [])
    found, _ = compare(program, CASES[name], rivals, steps, seed)
    rows = []
    for level in sorted({level for case in mine for level in case[3]}, reverse=True):
        best = {rival: at for rival in rivals
                if (at := crossings([(1.0 / row["step"], row["error"]) for row in found if row["method"] == rival], level))}
        if best:
            rival = min(best, key=lambda one: abs(best[one][-1]))
            rows.append({"case": name, "method": rival, "level": level, "first": best[rival][0], "last": best[rival][-1],
                         "charged": best[rival][-1], "prototype": math.nan, "bad": 0})
    return rows


def thresholds_or_rivals_of(program, case, seed):
    return (classical_thresholds_of if isinstance(case, str) else thresholds_of)(program, case, seed)


def other_of(program, name, seed):
    options = options_of_other(name)
    omega = highest_frequency(program, *options[:-2])
    steps = [float(f"{angle / omega:.3g}") for angle in RADIANS]
    rivals = RIVALS + (FITTED if name == "fpu_64" else [])
    rows = []
    classical, why = compare(program, options, rivals, steps, seed)
    if why:
        sys.exit(f"{name}: {why}")
    for family in OTHER_FAMILIES:
        found, why = compare(program, options, [f"learned:{family}"], steps, seed)
        by_step = {row["step"]: row for row in found}
        for step in steps:
            row = by_step.get(step)
            rows.append({"case": name, "method": f"learned:{family}", "step": step, "error": number(row),
                         "standard_error": number(row, "standard_error"),
                         "reason": why or (row or {}).get("reason") or ""})
    for step in steps:
        rival = best_of(classical, step)
        rows.append({"case": name, "method": rival["method"] if rival else "none", "step": step,
                     "error": number(rival), "standard_error": number(rival, "standard_error"), "reason": ""})
    return rows


def times_of(program, case, seed):
    """Seconds of processor time that `learn` takes; the machine may be busy with something else."""
    name, evaluation_step = case
    rows = []
    for family, evaluations in TIMED:
        step = float(f"{evaluation_step * evaluations:.4g}")
        started = subprocess.Popen([program, "learn", *map(str, CASES[name]), "--family", family, "--step", str(step),
                                    "--seed", str(seed), "--threads", "1", "--json"], stdout=subprocess.DEVNULL,
                                   stderr=subprocess.DEVNULL)
        _, _, used = os.wait4(started.pid, 0)
        rows.append({"case": name, "family": family, "step": evaluation_step,
                     "seconds": round(used.ru_utime + used.ru_stime, 2)})
    return rows


def as_text(value):
    return f"{value:.2g}" if is_number(value) else "-"


def cost(value):
    return "-" if not is_number(value) else f"below {-value:.3g}" if value < 0 else f"{value:.3g}"


def table(file, header, rows):
    print("| " + " | ".join(header) + " |\n" + "|---" * len(header) + "|", file=file)
    for row in rows:
        print("| " + " | ".join(row) + " |", file=file)
    print(file=file)


def write(folder, parts):
    for name, rows in parts.items():
        if not rows:
            continue
        with open(os.path.join(folder, f"{name}.csv"), "w", newline="", encoding="utf-8") as file:
            sheet = csv.DictWriter(file, rows[0].keys(), lineterminator="\n")
            sheet.writeheader()
            sheet.writerows(rows)
    with open(os.path.join(folder, "trajectories.md"), "w", encoding="utf-8") as file:
        if parts.get("errors"):
            table(file, ["case", "family", "step an evaluation", "`state:1`", "`trajectory`", "prototype",
                         "over the prototype", "best classical", ""],
                  [[row["case"], f"`{row['family']}`", f"{row['step']:g}", as_text(row["one_step"]),
                    f"{as_text(row['trajectory'])} ± {as_text(row['standard_error'])}", as_text(row["prototype"]),
                    f"{row['factor']:.2f}", f"{as_text(row['rival_error'])} `{row['rival']}`",
                    "bad" if row["bad"] else ""] for row in parts["errors"]])
        if parts.get("thresholds"):
            table(file, ["case", "error", "method", "first crossing", "last crossing", "with one observation", "prototype", ""],
                  [[row["case"], f"{row['level']:g}", f"`{row['method']}`", cost(row["first"]), cost(row["last"]),
                    cost(row["charged"]), cost(row["prototype"]), "bad" if row["bad"] else ""]
                   for row in parts["thresholds"]])
        for name in OTHER:
            rows = [row for row in parts.get("other", []) if row["case"] == name]
            if not rows:
                continue
            steps = sorted({row["step"] for row in rows})
            print(f"{OTHER[name][0]}:\n", file=file)
            lines = []
            for family in OTHER_FAMILIES:
                mine = {row["step"]: row for row in rows if row["method"] == f"learned:{family}"}
                lines.append([f"`{family}`", *(as_text(mine[step]["error"]) for step in steps)])
            rivals = {row["step"]: row for row in rows if not row["method"].startswith("learned")}
            lines.append(["best classical", *(f"{as_text(rivals[step]['error'])} `{rivals[step]['method']}`"
                                              for step in steps)])
            table(file, ["step an evaluation", *(f"{step:g}" for step in steps)], lines)
        if parts.get("times"):
            cases = list(dict.fromkeys((row["case"], row["step"]) for row in parts["times"]))
            table(file, ["seconds of one core", *(f"{name}, {step:g}" for name, step in cases)],
                  [[f"`{family}`", *(f"{row['seconds']:.1f}" for row in parts["times"] if row["family"] == family)]
                   for family, _ in TIMED])


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("folder")
    parser.add_argument("--parts", default="errors,thresholds,other,times")
    parser.add_argument("--cases")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    asked = parser.parse_args()
    os.makedirs(asked.folder, exist_ok=True)
    is_asked = lambda name: not asked.cases or name in asked.cases.split(",")
    all_work = {"errors": (errors_of, [case for case in ERRORS if is_asked(case[0])]),
                "thresholds": (thresholds_or_rivals_of, [*(case for case in THRESHOLDS if is_asked(case[0])),
                                                         *(name for name in CASES if is_asked(name))]),
                "other": (other_of, [name for name in OTHER if is_asked(name)]),
                "times": (times_of, [case for case in TIMES if is_asked(case[0])])}
    parts = {}
    with ThreadPoolExecutor(asked.jobs) as pool:
        for part in asked.parts.split(","):
            work, cases = all_work[part]
            parts[part] = []
            for rows in pool.map(lambda case, work=work: work(asked.program, case, asked.seed), cases):
                parts[part] += rows
                write(asked.folder, parts)  # what is known so far stays if the rest is stopped
    judged = [row for rows in parts.values() for row in rows if "bad" in row]
    bad = sum(row["bad"] for row in judged)
    print(f"{len(judged)} numbers beside the prototype's, {bad} bad")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
