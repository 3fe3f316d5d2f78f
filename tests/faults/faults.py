#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""Each call of the system that writes fails once, for good, or ends the process; then the work is done again.

usage: faults.py PROGRAM LIBRARY FOLDER [--some] [--works=NAME,...]; LIBRARY is fail.cpp compiled; the exit code is 1 if a promise was broken

No file gets its name before it is on the disk (fsync); that a call of fsync which is left out is seen is tried too.

After each failure every output is the old file or the whole new one (a picture may be gone, with a warning), the exit
code is 0 or 4, nothing unfinished stays (but what --resume goes on with), and doing the work again, with --resume where
there is something to resume, gives the bytes of a run that nothing happened to.
What a report says of seconds, and provenance, differs between runs: of such files the rest is compared, or the end.
--some: of each work one call of each kind fails once; kills are those of tests/programs/stopping_test.cpp.
"""
import os
import shutil
import subprocess
import sys

from works import WORKS, comparable, contents, files_of

PROGRAM = os.path.abspath(sys.argv[1])
LIBRARY = os.path.abspath(sys.argv[2])
FOLDER = os.path.abspath(sys.argv[3])
SOME = "--some" in sys.argv
CHOSEN = [name for word in sys.argv if word.startswith("--works=") for name in word.split("=")[1].split(",")]
OPERATIONS = ("write", "pwrite", "fflush", "fsync", "rename", "truncate")


def work(folder, arguments, **extra):
    environment = dict(os.environ, LD_PRELOAD=LIBRARY, **extra)
    return subprocess.run([PROGRAM, *arguments], cwd=folder, env=environment, capture_output=True, text=True)


def fresh(folder, files):
    shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(folder)
    for name in files:
        os.makedirs(os.path.dirname(os.path.join(folder, name)), exist_ok=True)
        with open(os.path.join(folder, name), "w") as file:
            file.write("old")


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
    if unfinished(folder) and not killed and not one.resumes_from:
        return f"left: {unfinished(folder)}"
    can_resume = one.resumes_from and os.path.exists(os.path.join(folder, one.resumes_from))
    done = work(folder, one.arguments + (["--resume"] if can_resume else []))
    if done.returncode != 0:
        return f"again: exit code {done.returncode}: {done.stderr.strip()[:200]}"
    for name, data in expected.items():
        if comparable(name, contents(folder, name)) != data:
            return f"again: {name} is another"
    return f"again: left {unfinished(folder)}" if unfinished(folder) else ""


if __name__ == "__main__":
    sys.exit(main())
