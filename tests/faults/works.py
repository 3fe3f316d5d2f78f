# SPDX-License-Identifier: BSL-1.0
"""Commands of the program that write, one for each kind of output, and what of their files is equal in equal works."""
import csv
import dataclasses
import io
import json
import os

ENDS = {".html": b"</html>", ".svg": b"</svg>", ".png": b"IEND\xaeB\x60\x82"}


@dataclasses.dataclass
class Work:
    name: str
    arguments: list
    outputs: list  # of a folder: all files that the work makes in it
    resumes_from: str = ""  # the file with which --resume goes on
    only_of_all: bool = False  # left out of --some


RUN = ["run", "--system", "fpu", "--method", "verlet", "--step", "0.004", "--horizon", "16", "--trajectories", "5",
       "--sample-every", "10", "--observables", "energy,q1", "--threads", "1"]
SAMPLE = ["sample", "--system", "henon_heiles", "--hmc-temperature", "0.01", "--length", "1", "--step", "0.3", "--chains", "2",
          "--draws", "40", "--burn-in", "40", "--threads", "1"]
HENON_HEILES = ["--system", "henon_heiles", "--trajectories", "5", "--threads", "1"]
WORKS = [
    *(Work(f"run {kind}{', saved often' if every else ''}",
           RUN + ["--output", f"out.{kind}"] + (["--every", "640"] if every else []), [f"out.{kind}"],
           f"out.{kind}.work", only_of_all=kind == "npy")
      for kind in ("csv", "npy", "h5") for every in (False, True)),
    Work("run, drawn", RUN + ["--output", "out.csv", "--plot"], ["out.csv", "out.dat", "out.gp", "out.svg", "out.png"],
         "out.csv.work", only_of_all=True),
    Work("sample", SAMPLE + ["--output", "out.csv"], ["out.csv"], "out.csv.work"),
    Work("sample, saved often", SAMPLE + ["--output", "out.csv", "--every", "20"], ["out.csv"], "out.csv.work"),
    Work("learn", ["learn", *HENON_HEILES, "--family", "bab2", "--step", "0.3", "--horizon", "3", "--effort", "quick", "--output",
                   "out.json"], ["out.json"], "out.json.work"),
    Work("recommend", ["recommend", "--system", "fpu", "--families", "fg4", "--metric", "energy", "--budget", "100", "--horizon",
                       "5", "--trajectories", "8", "--threads", "1", "--output", "out.json"], ["out.json"], "out.json.work",
         only_of_all=True),
    Work("stability", ["stability", "--method", "verlet", "--output", "out.csv"], ["out.csv"], only_of_all=True),
    Work("export", ["export", "srkn6b", "--to", "python", "--output", "out.py"], ["out.py"]),
    Work("compare", ["compare", *HENON_HEILES, "--methods", "verlet,learned:bab2", "--steps", "0.2,0.4", "--metric", "energy",
                     "--horizon", "4", "--seed", "2", "--output", "r"], ["r"], "r/report.work"),
]


def files_of(folder, outputs):
    """The files that a work has made."""
    found = []
    for output in outputs:
        path = os.path.join(folder, output)
        if os.path.isdir(path):
            found += [os.path.relpath(os.path.join(at, name), folder) for at, _, names in os.walk(path) for name in sorted(names)]
        else:
            found.append(output)
    return found


def contents(folder, name):
    with open(os.path.join(folder, name), "rb") as file:
        return file.read()


def without_measures(value):
    """Of a document, without what was measured of the run, seconds and memory, and its provenance."""
    if isinstance(value, dict):
        return {key: without_measures(inner) for key, inner in value.items()
                if "seconds" not in key and key not in ("peak_memory", "provenance")}
    return [without_measures(inner) for inner in value] if isinstance(value, list) else value


def comparable(name, data):
    """What of a file is equal in equal works; None for a file that is not whole."""
    kind = os.path.splitext(name)[1]
    if kind in ENDS and not data.rstrip().endswith(ENDS[kind]):
        return None
    if kind == ".json":
        try:
            return without_measures(json.loads(data))
        except ValueError:
            return None
    if name.endswith("rows.csv"):
        rows = list(csv.reader(io.StringIO(data.decode().partition("\n")[2])))  # without what they say of themselves
        kept = [i for i, title in enumerate(rows[0]) if "seconds" not in title]
        return [[row[i] for i in kept] for row in rows] if all(len(row) == len(rows[0]) for row in rows) else None
    if "seconds" in name or os.path.basename(name).startswith("report."):
        return "whole" if kind in ENDS or data.endswith(b"\n") else None
    return data
