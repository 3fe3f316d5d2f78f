#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""Each call of the system that writes fails once, for good, or ends the process; then the work is done again.

usage: faults.py PROGRAM FOLDER [--some]; the exit code is 1 if a promise was broken

After each failure the output is the old file or the whole new one, the exit code is 0 or 4, nothing unfinished stays
(but what a checkpoint goes on with), and doing the work again, from the checkpoint where there is one, gives the bytes of
a run that nothing happened to. The manifest of the folder is whole, and keeps the entry of another file. --some: a few calls of each kind.
"""
import json
import os
import shutil
import subprocess
import sys

PROGRAM = os.path.abspath(sys.argv[1])
FOLDER = os.path.abspath(sys.argv[2])
SOME = "--some" in sys.argv
LIBRARY = os.path.join(FOLDER, "fail.so")
RUN = ["run", "--method", "verlet", "--step", "0.01", "--horizon", "40", "--trajectories", "5", "--sample-every", "10",
       "--observables", "energy,q1", "--threads", "1"]
LEARN = ["learn", "--system", "henon_heiles", "--family", "bab2", "--step", "0.3", "--trajectories", "5", "--horizon", "3",
         "--effort", "quick", "--threads", "1"]
CASES = {f"run {kind}{' with a checkpoint' if every else ''}":
         (RUN + ["--output", f"out.{kind}"] + (["--checkpoint", "c", "--every", "640"] if every else []), f"out.{kind}", every)
         for kind in ("csv", "npy", "h5") for every in (False, True)}
CASES["learn"] = (LEARN + ["--output", "out.json"], "out.json", False)
OPERATIONS = ("write", "pwrite", "fsync", "rename", "ftruncate")


def work(folder, arguments, **extra):
    environment = dict(os.environ, LD_PRELOAD=LIBRARY, **extra)
    return subprocess.run([PROGRAM, *arguments], cwd=folder, env=environment, capture_output=True, text=True)


def fresh(folder, output):
    shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(folder)
    with open(os.path.join(folder, output), "w") as file:
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


def main():
    os.makedirs(FOLDER, exist_ok=True)
    source = os.path.join(os.path.dirname(os.path.abspath(__file__)), "fail.c")
    subprocess.run(["cc", "-O1", "-shared", "-fPIC", source, "-o", LIBRARY, "-ldl"], check=True)
    folder = os.path.join(FOLDER, "here")
    tried = wrong = 0
    print("| work | calls | failures tried | wrong |\n|---|---|---|---|")
    for name, (arguments, output, has_checkpoint) in CASES.items():
        fresh(folder, output)
        counts_file = os.path.join(FOLDER, "counts")
        if os.path.exists(counts_file):
            os.remove(counts_file)
        done = work(folder, arguments, NYSALT_FAULT_COUNTS=counts_file)
        if done.returncode == 2 and "built without" in done.stderr:
            continue
        assert done.returncode == 0, done.stderr
        expected = contents(folder, output)
        counts = {one.split()[0]: int(one.split()[1]) for one in open(counts_file)}
        here = bad = 0
        for operation in OPERATIONS:
            numbers = range(1, counts[operation] + 1)
            if SOME and len(numbers) > 2:
                numbers = [1, len(numbers) - 1]
            for number in numbers:
                for how in ("nospace", "kill") if SOME else ("nospace", "nospace_for_good", "io", "kill"):
                    here += 1
                    said = one_failure(folder, arguments, output, has_checkpoint, expected, f"{operation}:{number}:{how}")
                    if said:
                        bad += 1
                        print(f"{name}, {operation}:{number}:{how}: {said}", file=sys.stderr)
        print(f"| {name} | {', '.join(f'{counts[one]} {one}' for one in OPERATIONS if counts[one])} | {here} | {bad} |", flush=True)
        tried += here
        wrong += bad
    print(f"\n{tried} failures tried, {wrong} wrong")
    return wrong > 0


def one_failure(folder, arguments, output, has_checkpoint, expected, fault):
    """What is wrong after it; empty if nothing is."""
    fresh(folder, output)
    failed = work(folder, arguments, NYSALT_FAULT=fault)
    killed = fault.endswith("kill")
    if failed.returncode != (-9 if killed else failed.returncode) or (not killed and failed.returncode not in (0, 4)):
        if not (killed and failed.returncode == 0):
            return f"exit code {failed.returncode}: {failed.stderr.strip()[:200]}"
    now = contents(folder, output)
    if now not in (b"old", expected):
        return "the output is neither the old one nor the new one"
    if failed.returncode == 0 and now != expected:
        return "exit code 0 without the output"
    if failed.returncode == 4 and failed.stderr.count("\n") != 1:
        return f"the message is not one line: {failed.stderr[:200]}"
    if has_lost_an_entry(folder):
        return "the manifest is not whole, or has lost an entry"
    left = [one for one in os.listdir(folder) if ".part" in one]
    if left and not killed and not has_checkpoint:
        return f"left: {left}"
    again = arguments + (["--resume"] if os.path.exists(os.path.join(folder, "c")) else [])
    done = work(folder, again)
    if done.returncode != 0:
        return f"again: exit code {done.returncode}: {done.stderr.strip()[:200]}"
    if contents(folder, output) != expected:
        return "again: other bytes"
    if has_lost_an_entry(folder) or output not in json.loads(contents(folder, "manifest.json"))["files"]:
        return "again: the manifest has not both entries"
    left = [one for one in os.listdir(folder) if ".part" in one]
    return f"again: left {left}" if left else ""


if __name__ == "__main__":
    sys.exit(main())
