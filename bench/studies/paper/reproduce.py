#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""Every table and figure of the paper [li_lu_tao_ye_2023] beside what comes out here, and a verdict on each claim."""
import argparse
import collections
import datetime
import json
import os
import pathlib
import re
import sys
import warnings

sys.path[:0] = [str(pathlib.Path(__file__).resolve().parent), str(pathlib.Path(__file__).resolve().parents[2])]

import nysalt  # noqa: E402

import accuracy  # noqa: E402
import energies  # noqa: E402
import in_bath  # noqa: E402
import learning  # noqa: E402
import linear  # noqa: E402
from chain import Setting, chain  # noqa: E402
from claims import items  # noqa: E402
from pages import draw, markdown, processor  # noqa: E402

PARTS = {  # in the order of the paper, with titles
    "linear": ("Linear systems", linear.EXHIBITS),
    "deterministic": ("The chain without bath", (
        learning.table_1, learning.parameters_against_omega, learning.convergence_in_trajectories,
        accuracy.accuracy_on_short_times, accuracy.accuracy_on_long_times, energies.energy_transitions, energies.energies_at_200,
        energies.energies_at_400, energies.largest_stable_step, accuracy.other_starts, energies.growth_of_error,
        energies.conserved_action)),
    "langevin": ("The chain in a bath", (
        learning.parameters_against_gap, learning.convergence_in_bath, accuracy.errors_along_paths, in_bath.law_of_energy,
        in_bath.autocovariance_of_energy, in_bath.run_times))}
QUICK = ("This is a quick run, of few trajectories and steps: it shows that everything runs, and its verdicts have no weight.")


def counts(claims):
    found = collections.Counter("depends on how the text is read" if one["verdict"].startswith("depends") else one["verdict"]
                                for one in claims)
    return [f"{verdict}: {number}" for verdict, number in sorted(found.items())]


def plain(text):
    """Text in which Markdown finds nothing of its own."""
    return re.sub(r"([*\[\]<])", r"\\\1", str(text))


def page(parts, folder):
    """paper.md and the pictures in paper/."""
    claims = items(parts)
    lines = ["# The paper's claims, computed again", "",
             "Li, Lu, Tao, Ye: NySALT: Nystrom-type inference-based schemes adaptive to large time-stepping, Journal of Computational "
             "Physics 477 (2023). Every table and figure, its claims as they are printed, and what comes out here. `./dev reproduce` "
             "makes this page again.", "",
             f"{datetime.date.today()}, nysalt {nysalt.__version__}, {processor()}, {os.cpu_count()} cores, seed {Setting.seed}.", "",
             *([QUICK, ""] if Setting.quick else []),
             "A verdict follows from numbers by the rule beside it: **reproduced**, **not reproduced**, or **depends on** what the text "
             "leaves open; then all readings are computed. A printed number is reproduced within half of its last digit and two "
             "standard errors. Values are with one standard error.", "", *(f"- {one}" for one in counts(claims)), ""]
    for part in parts:
        rows = [[plain(one[key]) for key in ("claim", "ours", "verdict")] for one in claims if one["part"] == part]
        lines += [f"## {PARTS[part][0]}: summary", "", markdown(["claim", "ours", "verdict"], rows, 3)]
    for part, exhibits in parts.items():
        lines += [f"## {PARTS[part][0]}", ""]
        for exhibit in exhibits:
            lines += [f"### {exhibit.title}", "", f"{exhibit.place}.", ""]
            for one in exhibit.claims:
                lines += [f"**Claim:** {plain(one.claim)}.", "", f"- Measured: {plain(one.quantity)}.", f"- Ours: {plain(one.ours)}.",
                          f"- **{plain(one.verdict)}**: {plain(one.reason)}.", ""]
                lines += ["```", one.command, "```", ""] if one.command else []
            for remark in exhibit.remarks:
                lines += [plain(remark), ""]
            for sentence, columns, rows, left in exhibit.tables:
                lines += [plain(sentence), "", markdown([plain(one) for one in columns], rows, left)]
            for name, panels, size, caption in exhibit.figures:
                if not draw(folder / "paper" / name, panels, *size):
                    print(f"reproduce.py: gnuplot could not draw {name}", file=sys.stderr)
                lines += [f"![{plain(caption)}](paper/{name}.svg)", "", f"*{plain(caption)}*", ""]
    (folder / "paper.md").write_text("\n".join(lines), encoding="utf-8")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0], allow_abbrev=False)
    parser.add_argument("parts", nargs="*", metavar="PART", help=f"{', '.join(PARTS)} [all; some ten to twenty minutes]")
    parser.add_argument("--output", metavar="FOLDER", type=pathlib.Path, help="a folder to write: paper.md, paper.json and pictures")
    parser.add_argument("--quick", action="store_true", help="take few trajectories and steps, to see it run")
    parser.add_argument("--seed", type=int, default=1, help="[1]")
    parser.add_argument("--threads", type=int, help="[as nysalt]")
    asked = parser.parse_args()
    for part in asked.parts:
        if part not in PARTS:
            parser.error(f"PART must be one of {', '.join(PARTS)}, got '{part}'")
    if asked.output:
        try:
            (asked.output / "paper").mkdir(parents=True, exist_ok=True)
        except OSError as problem:
            parser.error(f"--output must be a folder that can be written, got '{asked.output}': {problem.strerror}")
    Setting.quick, Setting.seed, Setting.threads = asked.quick, asked.seed, asked.threads
    warnings.simplefilter("ignore")  # methods are tried beyond their stability, which is what the paper is about
    try:  # nysalt has the words on what a seed and threads may be
        nysalt.run(chain(), "verlet", 0.01, 0.01, seed=asked.seed, threads=asked.threads, checks=False)
    except ValueError as problem:
        parser.error(str(problem))
    parts = {}
    for part in (name for name in PARTS if name in (asked.parts or PARTS)):
        parts[part] = []
        for exhibit in PARTS[part][1]:
            print(f"reproduce.py: {part}, {exhibit.__name__.replace('_', ' ')} ...", file=sys.stderr)
            parts[part].append(exhibit())
    found = items(parts)
    if asked.output:
        page(parts, asked.output)
        made = {"date": str(datetime.date.today()), "machine": f"{processor()}, {os.cpu_count()} cores", "version": nysalt.__version__}
        text = json.dumps({"quick": asked.quick, "seed": asked.seed, "made": made, "items": found}, indent=2)
        (asked.output / "paper.json").write_text(text + "\n", encoding="utf-8")
    print(f"{QUICK}\n" if asked.quick else "", end="")
    for one in found:
        print(f"{one['claim']}\n  ours: {one['ours']}\n  {one['verdict']}")
    print("\n" + "\n".join(counts(found)))


if __name__ == "__main__":
    main()
