#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""Does a fit that is called usable keep all of its trajectories? A table over systems, families and steps.

usage: table.py PROGRAM FOLDER [--older PROGRAM] [--systems A,B] [--families A,B] [--jobs N]

Every bundled system, every family that the system serves, and six steps from .3 to .95 of the last stable one: a
fit that is usable, or gains nothing but may be used, is run from 64 starts that it has not seen, to T = 2000 or
over 10^4 steps, whichever is longer. The last stable step of a family of s evaluations is that of s equal
Verlet steps at the highest frequency met by the starts, 2 s/omega: no word has a longer first window.
An older program given by --older is asked the same: a twin that shows what the table can find.
Writes rows.csv, table.md.
"""
import argparse
import csv
import json
import math
import os
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor

PARTS = (0.3, 0.43, 0.56, 0.69, 0.82, 0.95)
SYSTEMS = ("oscillator", "linear_chain", "fpu", "henon_heiles", "pendulum", "kepler", "phi4", "lennard_jones")
STARTS = 64
HORIZON = 2000.0
STEPS = 10_000
RUN_SEED = 20_011  # of starts that no fit has seen


def ask(program, *arguments):
    """The document of a command, its exit code, and what it said on standard error."""
    done = subprocess.run([program, *map(str, arguments), "--json"], capture_output=True, text=True, check=False)
    try:
        return json.loads(done.stdout), done.returncode, done.stderr.strip()
    except json.JSONDecodeError:
        return None, done.returncode, done.stderr.strip()


def families_of(program):
    document, _, _ = ask(program, "list")
    return [one if isinstance(one, str) else one["name"] for one in document["families"]]


def highest_frequency(program, system):
    document, _, said = ask(program, "stability", "--system", system, "--method", "verlet", "--step", 1e-6)
    if document is None:
        sys.exit(f"{system}: {said}")
    return document["highest_frequency"]


def evaluations_of(program, family):
    document, _, _ = ask(program, "list")
    for one in document["families"]:
        if one["name"] == family:
            return one["evaluations_per_step"]
    raise KeyError(family)


def lost_of(program, system, step, scheme):
    """How many of the starts are lost, or why the run was refused."""
    steps = max(STEPS, math.ceil(HORIZON / step))
    with tempfile.TemporaryDirectory() as folder:
        document, code, said = ask(program, "run", "--system", system, "--method", scheme, "--step", repr(step),
                                   "--horizon", repr(steps * step), "--trajectories", STARTS, "--sample-every", steps,
                                   "--seed", RUN_SEED, "--output", os.path.join(folder, "run.csv"))
    if document is None:
        return None, said.splitlines()[-1] if said else f"exit code {code}"
    return len(document["diverged"]), ""


def examine(program, system, family, step):
    """One row: the verdict of the fit, its reason, and how many starts its run loses."""
    with tempfile.TemporaryDirectory() as folder:
        scheme = os.path.join(folder, "scheme.json")
        fit, code, said = ask(program, "learn", "--system", system, "--family", family, "--step", repr(step),
                              "--output", scheme)
        if fit is None:
            return {"verdict": "refused", "reason": said.splitlines()[-1] if said else f"exit code {code}"}
        row = {"verdict": fit.get("verdict", "usable" if fit["usable"] else "not usable"),
               "reason": fit["reason"] or "", "rival": fit.get("rival") or ""}
        if fit["usable"]:
            row["lost"], problem = lost_of(program, system, step, scheme)
            row["reason"] = row["reason"] or problem
        return row


def asked_for(description, what, **further):
    """The command line, with a list of families or of methods and further options; makes the folder."""
    parser = argparse.ArgumentParser(description=description.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("folder")
    parser.add_argument("--older")
    parser.add_argument("--systems", default=",".join(SYSTEMS))
    parser.add_argument("--" + what)
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    for name, default in further.items():
        parser.add_argument("--" + name, default=default)
    asked = parser.parse_args()
    os.makedirs(asked.folder, exist_ok=True)
    return asked


def main():
    asked = asked_for(__doc__, "families")
    listed, _, _ = ask(asked.program, "list")
    evaluations = {one["name"]: one["evaluations_per_step"] for one in listed["families"]}
    families = asked.families.split(",") if asked.families else list(evaluations)

    cases = []
    for system in asked.systems.split(","):
        omega = highest_frequency(asked.program, system)
        for family in families:
            for part in PARTS:
                step = float(f"{part * 2.0 * evaluations[family] / omega:.4g}")
                cases.append((system, family, part, step))

    def row_of(case):
        system, family, part, step = case
        row = {"system": system, "family": family, "part": part, "step": step}
        row.update(examine(asked.program, system, family, step))
        if asked.older:
            row.update({"older_" + key: value for key, value in examine(asked.older, system, family, step).items()})
        if sys.stderr.isatty():
            print(f"\r{system} {family} {part}    ", end="", file=sys.stderr)
        return row

    rows = []
    with ThreadPoolExecutor(asked.jobs) as pool:
        for row in pool.map(row_of, cases):
            rows.append(row)
            write(asked, rows)  # what is known so far stays if the rest is stopped
    bad = [row for row in rows if row.get("lost", 0) != 0]  # None: the run was refused
    print(f"{len(rows)} fits, {sum(row['verdict'] in ('usable', 'nothing gained') for row in rows)} may be used, "
          f"{len(bad)} of them lose a trajectory")
    return 1 if bad else 0


def write(asked, rows):
    fields = ["system", "family", "part", "step", "verdict", "rival", "lost", "reason"]
    if asked.older:
        fields += ["older_verdict", "older_lost", "older_reason"]
    with open(os.path.join(asked.folder, "rows.csv"), "w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, fields, extrasaction="ignore", lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)

    with open(os.path.join(asked.folder, "table.md"), "w", encoding="utf-8") as file:
        def say(*cells):
            print("| " + " | ".join(map(str, cells)) + " |", file=file)

        header = ["system", "fits", "usable", "nothing gained", "not usable", "cannot be learned",
                  "may be used and lose a trajectory"]
        if asked.older:
            header.append("of the older program")
        say(*header)
        say(*["---"] * len(header))
        for system in asked.systems.split(","):
            mine = [row for row in rows if row["system"] == system]
            count = lambda name: sum(row["verdict"] == name for row in mine)
            cells = [f"`{system}`", len(mine), count("usable"), count("nothing gained"), count("not usable"),
                     count("refused"), sum(bool(row.get("lost")) for row in mine)]
            if asked.older:
                cells.append(sum(bool(row.get("older_lost")) for row in mine))
            say(*cells)
        print("\nWhy fits may not be used:\n", file=file)
        say("reason", "fits")
        say("---", "---")
        reasons = {}
        for row in rows:
            if row["verdict"] in ("not usable", "refused"):
                kind = kind_of(row["reason"])
                reasons[kind] = reasons.get(kind, 0) + 1
        for kind, number in sorted(reasons.items(), key=lambda one: -one[1]):
            say(kind, number)


def kind_of(reason):
    """The reason without its numbers."""
    for words, kind in (("diverge", "a trajectory of the trial run diverges"),
                        ("departs by", "the energy of the trial run drifts"),
                        ("linearly stable", "not linearly stable on the frequencies of the system"),
                        ("magnifies", "a mode is magnified under soft forces"),
                        ("which soft forces couple", "a sum resonance of two modes"),
                        ("not moving", "no better than not moving"),
                        ("did not converge", "the search did not converge"),
                        ("worse than the parameters", "worse on held-out data than its start"),
                        ("reference's own error", "the reference's own error is not small"),
                        ("needs a", "the system does not serve the letters"),
                        ("need a", "the system does not serve the letters"),
                        ("must be quadratic", "the system does not serve the letters"),
                        ("ran away", "a parameter ran away")):
        if words in reason:
            return kind
    return reason[:100]


if __name__ == "__main__":
    sys.exit(main())
