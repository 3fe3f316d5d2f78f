#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""Does what a verdict promises hold? Judgements of all methods and families at six steps, tried on fresh runs.

usage: verdicts.py PROGRAM FOLDER [--systems A,B] [--methods A,B] [--families A,B] [--seeds N] [--most N] [--again] [--jobs N]

Systems are the bundled ones and five that no threshold was made on, three of them with close encounters. A method or a
fit at a step is judged by `stability` or `learn`; whatever is not `unstable` is then run from 512 fresh starts, four
times as long as the trial. A trajectory is lost if it diverges, or at its end |H - H_0| exceeds the median kinetic
energy of the runs. `good` promises that at most 2 % are lost. The other side: what loses none, and whose energy errs by
less than 1 % of the kinetic energy, must not be refused. The twin is the rule that asked whether the energy error grows,
and not whether it is large. Beside that each method is judged again by its coefficients in a table, by `run` and by
`compare`, and a fit by its file: all must show the same judgement, and a fit that is usable must hold.
With --seeds N a family is learned with each, and the verdicts of the seeds are compared; other commands are asked of
the first, and run from fresh starts.
--most N: of the rows that are not there yet only N are made. --again: the judgements that are there are made again, and
what was learned and run stays. Writes verdicts.csv, schemes/, to which a further call adds, and verdicts.md. Exit code 1 if a
promise is broken.
"""
import argparse
import csv
import json
import math
import os
import pathlib
import random
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor

from asking import BUNDLED, ask, highest_frequency

PARTS = (0.15, 0.3, 0.45, 0.6, 0.75, 0.95)  # of 2 s/omega, the last linearly stable step of s equal Verlet steps
FRESH_STARTS = 512
LONGER = 4
FRESH_SEED = 20_011
PROMISED = 0.02
SMALL_ERROR = 0.01


def charges(softening, strength):
    pairs = [("a-c", "b-d"), ("a-e", "b-f"), ("c-e", "d-f")]
    return " + ".join(f"({strength})/sqrt(({x})^2 + ({y})^2 + {softening})" for x, y in pairs)


TRIANGLE = "a=1,b=0,c=-0.5,d=0.87,e=-0.5,f=-0.87"
SYSTEMS = {name: ["--system", name] for name in BUNDLED}
SYSTEMS |= {
    "charges_in_a_trap": ["--potential", charges(0.0025, 1) + " + 0.5*(a^2 + b^2 + c^2 + d^2 + e^2 + f^2)",
                          "--variables", "a,b,c,d,e,f", "--around", TRIANGLE,
                          "--parameter", "deviation_q=0.3,deviation_p=0.5"],
    "three_bodies": ["--potential", charges(0.02, -1), "--variables", "a,b,c,d,e,f", "--around", TRIANGLE,
                     "--parameter", "deviation_q=0.1,deviation_p=0.3"],
    # Masses 3, 4 and 5 at rest in the corners of a right triangle [szebehely_peters_1967], with a little softening.
    "burrau": ["--potential", "-12/sqrt((a-c)^2 + (b-d)^2 + 1e-4) - 15/sqrt((a-e)^2 + (b-f)^2 + 1e-4) "
               "- 20/sqrt((c-e)^2 + (d-f)^2 + 1e-4)", "--variables", "a,b,c,d,e,f", "--mass", "3,3,4,4,5,5",
               "--around", "a=1,b=3,c=-2,d=-1,e=1,f=-1", "--parameter", "deviation_q=0.01,deviation_p=0.01"],
    "elastic_pendulum": ["--potential", "200*(sqrt(x^2 + y^2) - 1)^2 + y", "--variables", "x,y",
                         "--around", "x=0,y=-1", "--parameter", "deviation_q=0.05,deviation_p=0.7"],
    "henon_heiles_with_walls": ["--potential", "0.5*(x^2 + y^2) + x^2*y - y^3/3 + 0.25*(x^2 + y^2)^2",
                                "--variables", "x,y", "--parameter", "deviation_q=0.3,deviation_p=0.4"],
}


def fresh_losses(program, system, method, step, steps):
    """Share of fresh trajectories that are lost, and the largest energy error over the median kinetic energy."""
    with tempfile.TemporaryDirectory() as folder:
        table = os.path.join(folder, "run.csv")
        document, _, said = ask(program, "run", *SYSTEMS[system], "--method", method, "--step", repr(step), "--force",
                             "--horizon", repr(steps * step), "--trajectories", FRESH_STARTS, "--sample-every",
                             max(1, steps // 16), "--observables", "energy,kinetic_energy", "--seed", FRESH_SEED,
                             "--output", table, "--threads", 1)
        if document is None:
            return None, None, said
        energies, kinetic = {}, []
        with open(table, encoding="utf-8") as file:
            for row in csv.DictReader(line for line in file if not line.startswith("#")):
                energies.setdefault(row["trajectory"], []).append(float(row["energy"]))
                kinetic.append(float(row["kinetic_energy"]))
    diverged = {str(one["trajectory"]) for one in document["diverged"]}
    scale = sorted(kinetic)[len(kinetic) // 2]
    ends = [abs(all_of[-1] - all_of[0]) for number, all_of in energies.items() if number not in diverged]
    lost = len(diverged) + sum(not end <= scale for end in ends)
    largest = max((abs(energy - all_of[0]) for number, all_of in energies.items() if number not in diverged
                   for energy in all_of), default=0.0)
    return lost / FRESH_STARTS, largest / scale, ""


def contradictions(program, system, method, found, table):
    """Commands whose judgement is not that of `stability` or `learn`, which found it; `table` is a file to write."""
    at = [*SYSTEMS[system], "--threads", 1, "--force"]
    step = repr(found["judgement"]["step"])
    answers = {}
    answers["stability"], _, said = ask(program, "stability", *at, "--method", method, "--step", step)
    of = answers["stability"] or found
    if "letters" in of:
        with open(table, "w", encoding="utf-8") as file:
            json.dump({"format": "nysalt table", "version": 1, "name": "same", "letters": of["letters"],
                       "coefficients": of["coefficients"]}, file)
        answers["table"], _, _ = ask(program, "stability", *at, "--method", table, "--step", step)
    answers["run"], _, _ = ask(program, "run", *at, "--method", method, "--step", step, "--horizon",
                               repr(3 * float(step)))
    compared, _, _ = ask(program, "compare", *at, "--methods", method, "--steps", step, "--horizon",
                         repr(12 * float(step)), "--trajectories", 4, "--metric", "state")
    if compared is not None and compared["rows"]:
        answers["compare"] = compared["rows"][0]
    # Before a short run of a costly force `run` tries a part, and says so: that is no verdict.
    def is_other(name, one):
        judged = one["judgement"]
        in_part = name == "run" and judged["verdict"] == "not tried" and judged["trajectories"] > 0
        return not in_part and judged != found["judgement"]

    return [name for name, one in answers.items() if one is None or is_other(name, one)]


PAGE = """# Do verdicts hold?

Methods and learned families at steps of .15, .3, .45, .6, .75 and .95 of the last linearly stable one, judged and then run from
512 starts that no judge has seen, four times as long as the trial, unless the verdict is `unstable`
([judgement](../../concepts/judgement.md)). The systems are the bundled ones and five on which no threshold was made: charges in
a trap, three softened bodies, and the masses 3, 4 and 5 of Burrau's problem, all with close encounters; an elastic pendulum, and
Henon and Heiles' potential with walls. "By the twin": the older rule, by which a trial passed whose energy error did not grow, however
large it was. Rows are a random part of all, which would take days; [verdicts.csv](verdicts.csv) has each. Made by

```sh
bench/studies/soundness/verdicts.py build/release/nysalt build/soundness --seeds 8 --most 1000
```

"""


def row_of(program, schemes, system, kind, name, part, step, seed, known=None):
    """One row; fresh runs of `known` are not made again, if they are as long, nor is a scheme learned that is kept."""
    row = {"system": system, "kind": kind, "name": name, "part": part, "step": step, "seed": seed}
    with tempfile.TemporaryDirectory() as folder:
        if kind == "method":
            method = name
            found, _, said = ask(program, "stability", *SYSTEMS[system], "--method", method, "--step", repr(step),
                                 "--threads", 1)
        else:
            method = str(schemes / f"{system}_{name}_{part}_{seed}.json")
            found = None
            if os.path.exists(method):
                found, _, said = ask(program, "stability", *SYSTEMS[system], "--method", method, "--step", repr(step),
                                     "--threads", 1)
                with open(method, encoding="utf-8") as file:
                    usable = json.load(file)["usable"]
                if found is not None:
                    found["usable"] = usable
        if found is None and kind == "family":
            found, _, said = ask(program, "learn", *SYSTEMS[system], "--family", name, "--step", repr(step), "--seed",
                                 seed, "--effort", "quick", "--trajectories", 50, "--output", method, "--force",
                                 "--threads", 1)
            found = found and found["fits"][0]
        if found is None:
            return row | {"verdict": "refused", "reason": said.splitlines()[-1] if said else "no answer"}
        judged = found["judgement"]
        error = judged["energy_error"] or {}
        row |= {"verdict": judged["verdict"], "reason": judged["reason"] or "", "steps": judged["steps"],
                "share_lost": judged["share_lost"], "error": error.get("largest", ""), "growth": error.get("growth", "")}
        grew = math.sqrt(10.0)  # of a random walk ten times as long
        row["twin"] = judged["diverged"] == 0 and not (error and error["largest"] > 0.05 and error["growth"] > grew)
        differ = []
        if int(seed) == 1:  # of further seeds the same would be asked again
            differ = contradictions(program, system, method, found, os.path.join(folder, "table.json"))
        if kind == "family" and found["usable"] and judged["verdict"] not in ("good", "near an edge"):
            differ.append("usable")
        row["contradictions"] = " ".join(differ) or ("none" if int(seed) == 1 else "")
        if known and known["fresh_lost"] and int(known["steps"]) == judged["steps"]:
            row |= {"fresh_lost": known["fresh_lost"], "fresh_error": known["fresh_error"]}
        elif judged["verdict"] != "unstable" and int(seed) == 1:
            lost, largest, said = fresh_losses(program, system, method, step, LONGER * judged["steps"])
            row |= {"fresh_lost": lost if lost is not None else "", "fresh_error": largest if lost is not None else "",
                    "reason": row["reason"] or said}
    return row


def cases_of(asked):
    """Cells of the table; each is a list of cases that differ by the seed."""
    listed, _, _ = ask(asked.program, "list")
    chosen = lambda names, only: [one for one in names if only is None or one["name"] in only.split(",")]
    methods = chosen([one for one in listed["methods"] if "O" not in one["letters"]], asked.methods)
    families = chosen(listed["families"], asked.families)
    for system in asked.systems.split(","):
        omega = highest_frequency(asked.program, *SYSTEMS[system]) or 1.0
        for kind, names, seeds in (("method", methods, 1), ("family", families, asked.seeds)):
            for one in names:
                for part in PARTS:
                    step = float(f"{part * 2.0 * one['evaluations_per_step'] / omega:.4g}")
                    yield [(system, kind, one["name"], part, step, seed) for seed in range(1, seeds + 1)]


def number(row, name):
    return float(row[name]) if row.get(name) not in (None, "") else None


def summarise(asked, rows):
    """Writes the table; returns how many promises are broken."""
    tried = [row for row in rows if number(row, "fresh_lost") is not None]
    good = [row for row in tried if row["verdict"] == "good"]
    broken = [row for row in good if number(row, "fresh_lost") > PROMISED]
    lost_of = lambda row: number(row, "share_lost") if number(row, "fresh_lost") is None else number(row, "fresh_lost")
    twin = [row for row in rows if str(row.get("twin")) == "True" and lost_of(row) > PROMISED]
    fine = [row for row in tried if number(row, "fresh_lost") == 0 and number(row, "fresh_error") < SMALL_ERROR]
    refused = [row for row in fine if row["verdict"] not in ("good", "near an edge")]
    asked_again = [row for row in rows if row.get("contradictions")]
    contradicted = [row for row in asked_again if row["contradictions"] != "none"]
    cells = {}
    for row in rows:
        if row["kind"] == "family" and row["verdict"] != "refused":
            cells.setdefault((row["system"], row["name"], row["part"]), []).append(row["verdict"])
    several = [verdicts for verdicts in cells.values() if len(verdicts) > 1]
    agreed = sum(len(set(verdicts)) == 1 for verdicts in several)
    with open(os.path.join(asked.folder, "verdicts.md"), "w", encoding="utf-8") as file:
        def say(*of_row):
            print("| " + " | ".join(map(str, of_row)) + " |", file=file)

        file.write(PAGE)
        verdicts = ("good", "near an edge", "loses trajectories", "unstable", "not tried", "refused")
        header = ["system", "cells", *verdicts, "of the good, lost more than 2 %", "of those good by the twin"]
        say(*header)
        say(*["---"] * len(header))
        for system in dict.fromkeys(row["system"] for row in rows):
            mine = [row for row in rows if row["system"] == system]
            say(f"`{system}`", len(mine), *(sum(row["verdict"] == one for row in mine) for one in verdicts),
                sum(row["system"] == system for row in broken), sum(row["system"] == system for row in twin))
        print(f"\nOf {len(good)} that are called good {len(broken)} lose more than 2 % in fresh runs, by the twin "
              f"{len(twin)}; of {len(fine)} that lose none and err by less than 1 % of the kinetic energy "
              f"{len(refused)} are refused.", file=file)
        print(f"{len(contradicted)} of {len(asked_again)} are judged differently by another command.", file=file)
        if several:
            seeds = sorted({len(verdicts) for verdicts in several})
            print(f"\nOf {len(several)} cells that were learned from {' or '.join(map(str, seeds))} seeds {agreed} have one "
                  "verdict.", file=file)
        if broken + refused + contradicted:
            print(file=file)
        for row in broken + refused:
            print(f"- {row['system']} {row['name']} {row['step']}: {row['verdict']}, fresh runs lose "
                  f"{row['fresh_lost']}", file=file)
        for row in contradicted:
            print(f"- {row['system']} {row['name']} {row['step']}: not as by {row['contradictions']}", file=file)
    return len(broken) + len(refused) + len(contradicted)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--systems", default=",".join(SYSTEMS))
    parser.add_argument("--methods")
    parser.add_argument("--families")
    parser.add_argument("--seeds", type=int, default=1)
    parser.add_argument("--most", type=int)
    parser.add_argument("--again", action="store_true")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    asked = parser.parse_args()
    if unknown := set(asked.systems.split(",")) - set(SYSTEMS):
        parser.error(f"--systems must name some of {', '.join(SYSTEMS)}, got {', '.join(sorted(unknown))}")
    schemes = asked.folder / "schemes"
    schemes.mkdir(parents=True, exist_ok=True)
    table = asked.folder / "verdicts.csv"
    fields = ["system", "kind", "name", "part", "step", "seed", "verdict", "reason", "steps", "share_lost", "error", "growth",
              "contradictions", "twin", "fresh_lost", "fresh_error"]
    rows = []
    if table.exists():
        with open(table, newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
    key = lambda row: tuple(str(row[name]) for name in fields[:6])
    if asked.again:
        made = {key(row): row for row in rows}
        with ThreadPoolExecutor(asked.jobs) as pool:
            again = list(pool.map(lambda row: row_of(asked.program, schemes, row["system"], row["kind"], row["name"], row["part"],
                                                     float(row["step"]), row["seed"], row), made.values()))
        rows = again
        with open(table, "w", newline="", encoding="utf-8") as file:
            writer = csv.DictWriter(file, fields, extrasaction="ignore", lineterminator="\n")
            writer.writeheader()
            writer.writerows(rows)
    known = {key(row) for row in rows}
    cells = list(cases_of(asked))
    random.Random(1).shuffle(cells)  # what is done first is a sample of all
    new = [case for cell in cells for case in cell if tuple(map(str, case)) not in known]
    with open(table, "a", newline="", encoding="utf-8") as file, ThreadPoolExecutor(asked.jobs) as pool:
        writer = csv.DictWriter(file, fields, extrasaction="ignore", lineterminator="\n")
        if not rows:
            writer.writeheader()
        for row in pool.map(lambda case: row_of(asked.program, schemes, *case), new[:asked.most]):
            rows.append(row)
            writer.writerow(row)
            file.flush()
            if sys.stderr.isatty():
                print(f"\r{len(rows)} rows ", end="", file=sys.stderr)
    broken = summarise(asked, rows)
    print((asked.folder / "verdicts.md").read_text(encoding="utf-8"))
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main())
