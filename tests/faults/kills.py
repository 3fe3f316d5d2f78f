#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""Long commands are killed at random moments and gone on with, alone and on ranks.

usage: kills.py PROGRAM FOLDER [--kills=20] [--ranks=1,4] [--works=NAME,...] [--seed=1]; the exit code is 1 if a promise was broken

A kill (SIGKILL, of all ranks) comes at a moment that is uniform in the time that the command takes, and so does one of
the command that goes on. The same command with --resume must then give the files of a command that nothing happened to,
and leave nothing else. At least half
of the kills must come before the end, and some must leave work: else they tell nothing.
"""
import os
import random
import shutil
import signal
import subprocess
import sys
import time

from works import Work, comparable, contents, files_of

PROGRAM = os.path.abspath(sys.argv[1])
FOLDER = os.path.abspath(sys.argv[2])
FPU = ["--system", "fpu", "--threads", "1"]
WORKS = [
    Work("run", ["run", *FPU, "--method", "verlet", "--step", "0.004", "--horizon", "4000", "--trajectories", "24",
                 "--sample-every", "1000", "--friction", "0.1", "--temperature", "0.01", "--output", "out.csv"], ["out.csv"]),
    Work("run h5", ["run", *FPU, "--method", "srkn6b", "--step", "0.03", "--horizon", "60000", "--trajectories", "24",
                    "--sample-every", "1000", "--output", "out.h5"], ["out.h5"]),
    Work("sample", ["sample", "--system", "phi4", "--length", "1", "--step", "0.3", "--chains", "64", "--draws", "3000",
                    "--burn-in", "300", "--threads", "1", "--output", "out.csv"], ["out.csv"]),
    Work("learn", ["learn", *FPU, "--family", "bab5", "--steps", "0.02,0.03,0.04,0.05,0.06", "--effort", "quick", "--output",
                   "out.json"], ["out.json"]),
    # What bab4 learns on the chain has infinite errors: a fit that is given up in a valley comes back, too.
    Work("compare", ["compare", *FPU, "--methods", "verlet,bcss3,srkn6b,learned:bab4", "--steps", "0.005,0.01", "--equal-cost",
                     "--horizon", "20", "--trajectories", "64", "--metric", "state,energy", "--learn-effort", "quick",
                     "--output", "r"], ["r"]),
    Work("recommend", ["recommend", *FPU, "--families", "bab4,fg4", "--learn-trajectories", "32", "--budget", "80", "--horizon", "5", "--output",
                       "out.json"], ["out.json"]),
]


def chosen(name, default):
    return next((word.split("=", 1)[1] for word in sys.argv if word.startswith(f"--{name}=")), default)


def started(folder, arguments, ranks):
    command = [PROGRAM, *arguments]
    if ranks > 1:
        command = ["mpirun", "--oversubscribe", "-n", str(ranks), *command]
    return subprocess.Popen(command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)


def descendants(process):
    """Of a process, the process itself first: ranks are children of mpirun, in sessions of their own."""
    parents = {}
    for name in filter(str.isdigit, os.listdir("/proc")):
        try:
            with open(f"/proc/{name}/stat") as file:
                parents[int(name)] = int(file.read().rpartition(")")[2].split()[1])
        except OSError:
            continue
    found = [process]
    for one in found:
        found += [child for child, parent in parents.items() if parent == one]
    return found


def kill(process):
    for one in descendants(process.pid):
        try:
            os.kill(one, signal.SIGKILL)
        except ProcessLookupError:
            pass
    process.communicate()


def done(folder, arguments, ranks):
    process = started(folder, arguments, ranks)
    said = process.communicate()[0]
    return process.returncode, said


def fresh(folder):
    shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(folder)


def main():
    os.makedirs(FOLDER, exist_ok=True)
    folder = os.path.join(FOLDER, "here")
    kills = int(chosen("kills", "20"))
    moments = random.Random(int(chosen("seed", "1")))
    names = chosen("works", ",".join(one.name for one in WORKS)).split(",")
    wrong = 0
    print("| work | ranks | seconds | kills | before the end | gone on with | wrong |\n|---|---|---|---|---|---|---|")
    for one in WORKS:
        if one.name not in names:
            continue
        for ranks in map(int, chosen("ranks", "1,4").split(",")):
            fresh(folder)
            began = time.monotonic()
            code, said = done(folder, one.arguments, ranks)
            seconds = time.monotonic() - began
            if code == 2 and "built without" in said:
                continue
            assert code == 0, said
            expected = {name: comparable(name, contents(folder, name)) for name in files_of(folder, one.outputs)}
            early = resumed = bad = 0
            for n in range(kills):
                fresh(folder)
                code, said, has_left = -1, "", False
                for resume in ([], ["--resume"]):
                    process = started(folder, one.arguments + resume, ranks)
                    try:
                        said = process.communicate(timeout=moments.uniform(0.0, seconds))[0]
                        code = process.returncode
                    except subprocess.TimeoutExpired:
                        kill(process)
                        code = -9
                        early += resume == []
                    is_there = any(name.endswith(".work") for _, _, files in os.walk(folder) for name in files)
                    has_left = has_left or is_there
                    if not is_there:
                        break
                resumed += has_left
                again = code if code >= 0 else 0
                if code < 0:
                    again, said = done(folder, one.arguments + ["--resume"], ranks)
                    if again == 2 and "the output is there" in said:
                        again = 0  # killed when all was done
                left = [name for _, _, files in os.walk(folder) for name in files if ".part" in name or ".work" in name]
                differing = [name for name, data in expected.items() if again == 0 and comparable(name, contents(folder, name)) != data]
                if again != 0 or left or differing:
                    bad += 1
                    print(f"{one.name}, {ranks} ranks, kill {n}: exit code {again}, left {left}, other than without a kill: "
                          f"{differing}; {said.strip()[-300:]}", file=sys.stderr)
            if 2 * early < kills or (kills >= 10 and resumed == 0):
                bad += 1
                print(f"{one.name}, {ranks} ranks: {early} kills came before the end, {resumed} left work: they tell nothing",
                      file=sys.stderr)
            print(f"| {one.name} | {ranks} | {seconds:.1f} | {kills} | {early} | {resumed} | {bad} |", flush=True)
            wrong += bad
    print(f"\n{wrong} wrong")
    return wrong > 0


if __name__ == "__main__":
    sys.exit(main())
