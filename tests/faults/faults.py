#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""Each call of the system that writes fails once, for good, or ends the process; then the work is done again.

usage: faults.py PROGRAM LIBRARY FOLDER [--some] [--works=NAME,...]; LIBRARY is fail.cpp compiled; the exit code is 1 if a promise was broken

No file gets its name before it is on the disk (fsync); that a call of fsync which is left out is seen is tried too.

After each failure every output is the old file or the whole new one (a picture may be gone, with a warning), the exit
code is 0 or 4, nothing unfinished stays (but what --resume goes on with), and doing the work again, with --resume where
there is something to resume, gives the bytes of a run that nothing happened to. The manifest of the folder is whole, and
keeps the entry of another file. What a report says of seconds differs between runs: of such files the rest is compared,
or the end.
--some: of each work one call of each kind fails once; kills are those of tests/programs/stopping_test.cpp.
"""
import csv
import dataclasses
import io
import json
import os
import shutil
import subprocess
import sys

PROGRAM = os.path.abspath(sys.argv[1])
LIBRARY = os.path.abspath(sys.argv[2])
FOLDER = os.path.abspath(sys.argv[3])
SOME = "--some" in sys.argv
CHOSEN = [name for word in sys.argv if word.startswith("--works=") for name in word.split("=")[1].split(",")]
OPERATIONS = ("write", "pwrite", "fflush", "fsync", "rename", "ftruncate")
ENDS = {".html": b"</html>", ".svg": b"</svg>", ".png": b"IEND\xaeB\x60\x82"}


@dataclasses.dataclass
class Work:
    name: str
    arguments: list
    outputs: list  # of a folder: all files that the work makes in it
    resumes_from: str = ""  # the file with which --resume goes on
    only_of_all: bool = False  # left out of --some


RUN = ["run", "--method", "verlet", "--step", "0.004", "--horizon", "16", "--trajectories", "5", "--sample-every", "10",
       "--observables", "energy,q1", "--threads", "1"]
SAMPLE = ["sample", "--system", "henon_heiles", "--hmc-temperature", "0.01", "--length", "1", "--step", "0.3", "--chains", "2",
          "--draws", "40", "--burn-in", "40", "--threads", "1"]
HENON_HEILES = ["--system", "henon_heiles", "--trajectories", "5", "--threads", "1"]
WORKS = [
    *(Work(f"run {kind}{' with a checkpoint' if every else ''}",
           RUN + ["--output", f"out.{kind}"] + (["--checkpoint", "c", "--every", "640"] if every else []), [f"out.{kind}"],
           "c" if every else "", only_of_all=kind == "npy")
      for kind in ("csv", "npy", "h5") for every in (False, True)),
    Work("run, drawn", RUN + ["--output", "out.csv", "--plot"], ["out.csv", "out.dat", "out.gp", "out.svg", "out.png"],
         only_of_all=True),
    Work("sample", SAMPLE + ["--output", "out.csv"], ["out.csv"]),
    Work("sample with a checkpoint", SAMPLE + ["--output", "out.csv", "--checkpoint", "c", "--every", "20"], ["out.csv"], "c"),
    Work("learn", ["learn", *HENON_HEILES, "--family", "bab2", "--step", "0.3", "--horizon", "3", "--effort", "quick", "--output",
                   "out.json"], ["out.json"]),
    Work("recommend", ["recommend", "--system", "fpu", "--families", "fg4", "--metric", "energy", "--budget", "100", "--horizon",
                       "5", "--trajectories", "8", "--threads", "1", "--output", "out.json"], ["out.json"], only_of_all=True),
    Work("stability", ["stability", "--method", "verlet", "--output", "out.csv"], ["out.csv"], only_of_all=True),
    Work("export", ["export", "srkn6b", "--to", "python", "--output", "out.py"], ["out.py"]),
    Work("compare", ["compare", *HENON_HEILES, "--methods", "verlet,learned:bab2", "--steps", "0.2,0.4", "--metric", "energy",
                     "--horizon", "4", "--seed", "2", "--output", "r"], ["r"], "r/journal.jsonl"),
]


def work(folder, arguments, **extra):
    environment = dict(os.environ, LD_PRELOAD=LIBRARY, **extra)
    return subprocess.run([PROGRAM, *arguments], cwd=folder, env=environment, capture_output=True, text=True)


def files_of(folder, outputs):
    """The files that a work has made, without manifests."""
    found = []
    for output in outputs:
        path = os.path.join(folder, output)
        if os.path.isdir(path):
            found += [os.path.relpath(os.path.join(at, name), folder) for at, _, names in os.walk(path) for name in sorted(names)
                      if name != "manifest.json"]
        else:
            found.append(output)
    return found


def fresh(folder, files):
    shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(folder)
    for name in files:
        os.makedirs(os.path.dirname(os.path.join(folder, name)), exist_ok=True)
        with open(os.path.join(folder, name), "w") as file:
            file.write("old")
    with open(os.path.join(folder, "manifest.json"), "w") as file:
        json.dump({"format": "nysalt manifest", "version": 1, "files": {"other.csv": {"command": "none"}}}, file)


def has_lost_an_entry(folder):
    """Of a file that the work does not write."""
    try:
        return "other.csv" not in json.loads(contents(folder, "manifest.json"))["files"]
    except ValueError:
        return True


def contents(folder, name):
    with open(os.path.join(folder, name), "rb") as file:
        return file.read()


def without_measures(value):
    """Of a document, without what was measured of the run: seconds and memory."""
    if isinstance(value, dict):
        return {key: without_measures(inner) for key, inner in value.items() if "seconds" not in key and key != "peak_memory"}
    return [without_measures(inner) for inner in value] if isinstance(value, list) else value


def comparable(name, data):
    """What of a file is equal in equal works; None for a file that is not whole."""
    kind = os.path.splitext(name)[1]
    if kind in ENDS and not data.rstrip().endswith(ENDS[kind]):
        return None
    if name.endswith("report.json"):
        try:
            return without_measures(json.loads(data))
        except ValueError:
            return None
    if name.endswith("rows.csv"):
        rows = list(csv.reader(io.StringIO(data.decode())))
        kept = [i for i, title in enumerate(rows[0]) if "seconds" not in title]
        return [[row[i] for i in kept] for row in rows] if all(len(row) == len(rows[0]) for row in rows) else None
    if "seconds" in name or os.path.basename(name).startswith("report."):
        return "whole" if kind in ENDS or data.endswith(b"\n") else None
    return data


def unfinished(folder):
    return [name for at, _, names in os.walk(folder) for name in names if ".part" in name or name.endswith(".tmp")]


def counted(path):
    """Calls of each operation in the process that makes most of them; processes that draw have calls of their own."""
    counts = dict.fromkeys(OPERATIONS, 0)
    with open(path) as file:
        for line in file:
            operation, count = line.split()
            if operation != "unsynced":
                counts[operation] = max(counts[operation], int(count))
    return counts


def unsynced(path):
    """Files of the folder that were renamed before they were on the disk; gnuplot renames some elsewhere."""
    with open(path) as file:
        return [line.split()[1] for line in file if line.startswith("unsynced ") and not line.startswith("unsynced /")]


def missed_fsync(folder, one, counts_file):
    """What is wrong with how files are put on the disk; empty if nothing is."""
    if unsynced(counts_file):
        return f"renamed before they were on the disk: {unsynced(counts_file)}"
    fresh(folder, [])
    os.remove(counts_file)
    work(folder, one.arguments, NYSALT_FAULT="fsync:1:skip", NYSALT_FAULT_COUNTS=counts_file)
    return "" if unsynced(counts_file) else "a call of fsync that was left out is not seen"


def main():
    os.makedirs(FOLDER, exist_ok=True)
    folder = os.path.join(FOLDER, "here")
    tried = wrong = 0
    print("| work | calls | failures tried | wrong |\n|---|---|---|---|")
    for one in WORKS:
        if (SOME and one.only_of_all) or (CHOSEN and one.name not in CHOSEN):
            continue
        fresh(folder, [])
        counts_file = os.path.join(FOLDER, "counts")
        if os.path.exists(counts_file):
            os.remove(counts_file)
        done = work(folder, one.arguments, NYSALT_FAULT_COUNTS=counts_file)
        if done.returncode == 2 and ("built without" in done.stderr or "gnuplot" in done.stderr):
            continue
        assert done.returncode == 0, done.stderr
        expected = {name: comparable(name, contents(folder, name)) for name in files_of(folder, one.outputs)}
        assert None not in expected.values(), [name for name, data in expected.items() if data is None]
        counts = counted(counts_file)
        here, bad = 1, 0
        if said := missed_fsync(folder, one, counts_file):
            bad += 1
            print(f"{one.name}: {said}", file=sys.stderr)
        for operation in OPERATIONS:
            numbers = range(1, counts[operation] + 1)
            if SOME:
                numbers = numbers[(len(numbers) - 1) // 2:][:1]
            for number in numbers:
                for how in ("nospace",) if SOME else ("nospace", "nospace_for_good", "io", "kill"):
                    here += 1
                    said = one_failure(folder, one, expected, f"{operation}:{number}:{how}")
                    if said:
                        bad += 1
                        print(f"{one.name}, {operation}:{number}:{how}: {said}", file=sys.stderr)
        print(f"| {one.name} | {', '.join(f'{counts[name]} {name}' for name in OPERATIONS if counts[name])} | {here} | {bad} |",
              flush=True)
        tried += here
        wrong += bad
    print(f"\n{tried} failures tried, {wrong} wrong")
    return wrong > 0


def one_failure(folder, one, expected, fault):
    """What is wrong after it; empty if nothing is."""
    fresh(folder, expected)
    failed = work(folder, one.arguments, NYSALT_FAULT=fault)
    killed = fault.endswith("kill")
    if failed.returncode not in ((-9, 0) if killed else (0, 4)):
        return f"exit code {failed.returncode}: {failed.stderr.strip()[:200]}"
    for name, data in expected.items():
        if name.endswith((".svg", ".png")) and not os.path.exists(os.path.join(folder, name)):
            if failed.returncode == 0 and "could not draw" not in failed.stderr:
                return f"{name} is gone without a word"
            continue  # no picture of older data stays
        now = contents(folder, name)
        if now != b"old" and comparable(name, now) != data:
            return f"{name} is neither the old one nor the new one"
        if failed.returncode == 0 and now == b"old" and not killed:
            return f"exit code 0 without {name}"
    if failed.returncode == 4 and failed.stderr.count("\n") != 1:
        return f"the message is not one line: {failed.stderr[:200]}"
    if has_lost_an_entry(folder):
        return "the manifest is not whole, or has lost an entry"
    if unfinished(folder) and not killed and not one.resumes_from:
        return f"left: {unfinished(folder)}"
    can_resume = one.resumes_from and os.path.exists(os.path.join(folder, one.resumes_from))
    done = work(folder, one.arguments + (["--resume"] if can_resume else []))
    if done.returncode != 0:
        return f"again: exit code {done.returncode}: {done.stderr.strip()[:200]}"
    for name, data in expected.items():
        if comparable(name, contents(folder, name)) != data:
            return f"again: {name} is another"
    if has_lost_an_entry(folder):
        return "again: the manifest has lost an entry"
    for name in expected:
        at, last = os.path.split(os.path.join(folder, name))
        if last not in json.loads(contents(at, "manifest.json"))["files"]:
            return f"again: the manifest has no entry of {name}"
    return f"again: left {unfinished(folder)}" if unfinished(folder) else ""


if __name__ == "__main__":
    sys.exit(main())
