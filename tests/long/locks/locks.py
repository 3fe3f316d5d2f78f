#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""Every output of the program on a file system without locks, where a lock is held, and where asking is interrupted.

usage: locks.py PROGRAM COMPILER FAULTS FOLDER; FAULTS is tests/faults/fail.cpp compiled; the exit status is 1 if a promise
was broken

flock.c, compiled with COMPILER and preloaded, has each call of flock() fail with one error:
  ENOSYS, ENOLCK, EOPNOTSUPP   the file system has no locks: exit code 0, one line says so, the files are those of a run
                               with locks
  EWOULDBLOCK                  another process holds the lock: the exit code of a lock that really is held, and its message
  EINTR, every other time      is asked again: exit code 0, the same files, nothing is said; a lock that is held is seen
A work with --resume is begun with locks, is killed, and goes on without. What it left unfinished may be removed there when
it is 10 s old; a younger file may be that of another process. Prints a table.
"""
import dataclasses
import fcntl
import os
import re
import shutil
import subprocess
import sys
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "faults"))
from works import RUN, WORKS, Work, comparable, contents, files_of  # noqa: E402

PROGRAM, COMPILER, FAULTS, FOLDER = (os.path.abspath(path) for path in sys.argv[1:5])
STUB = os.path.join(FOLDER, "flock.so")
CACHE = os.path.join(FOLDER, "cache")
MISSING = ("ENOSYS", "ENOLCK", "EOPNOTSUPP")
WARNING = re.compile(r"nysalt: warning: the file system of \S+ has no locks: [^\n]*\n")
CONFLICT = re.compile(r"nysalt: cannot write \S+: another process writes it[^\n]*\n")


@dataclasses.dataclass
class Case:
    work: Work
    begun: list = dataclasses.field(default_factory=list)  # what is done before with locks
    killed_at: str = ""  # as fail.cpp takes it

    @property
    def name(self):
        return self.work.name + (", resumed" if "--resume" in self.work.arguments else "")


def cases():
    for work in WORKS:
        yield Case(work)
        if work.resumes_from:
            resumed = dataclasses.replace(work, arguments=[*work.arguments, "--resume"])
            yield Case(resumed, work.arguments, "rename:2:kill")  # when the first part would be there
    longer = [*RUN, "--output", "out.csv", "--keep-work"]
    shorter = [word if word != "16" else "8" for word in longer]
    yield Case(Work("run after its end", [*longer, "--resume"], ["out.csv"], "out.csv.work"), shorter)
    yield Case(Work("stability, drawn", ["stability", "--method", "verlet", "--output", "out.csv", "--plot"],
                    ["out.csv", "out.dat", "out.gp", "out.svg", "out.png"]))
    yield Case(Work("new", ["new", "mine"], ["mine.hpp"]))
    yield Case(Work("build", ["build", "mine.hpp"], ["mine.so"]), ["new", "mine"])


def run(folder, arguments, **environment):
    return subprocess.run([PROGRAM, *arguments], cwd=folder, capture_output=True, text=True, check=False,
                          env={**os.environ, "XDG_CACHE_HOME": CACHE, **environment})


def begun(case, folder, age=11):
    """An empty folder, or one in which the case can go on; what is unfinished there was written `age` seconds ago."""
    shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(folder)
    if case.begun:
        fault = {"LD_PRELOAD": FAULTS, "NYSALT_FAULT": case.killed_at} if case.killed_at else {}
        before = run(folder, case.begun, **fault)
        assert before.returncode == (-9 if case.killed_at else 0), (case.name, before)
        assert not case.work.resumes_from or os.path.exists(os.path.join(folder, case.work.resumes_from)), case.name
        for name in os.listdir(folder):
            if name.endswith(".part"):
                os.utime(os.path.join(folder, name), (time.time() - age,) * 2)


def results(case, folder):
    names = files_of(folder, case.work.outputs)
    return {name: comparable(name, contents(folder, name)) if os.path.exists(os.path.join(folder, name)) else None for name in names}


def held(case, folder):
    """Open files with the locks that a process holds which does the same work."""
    names = [case.work.outputs[0] + ending for ending in (".part", ".new.part")]
    if case.work.resumes_from:
        names = [case.work.resumes_from]
    files = []
    for name in names:
        os.makedirs(os.path.dirname(os.path.join(folder, name)), exist_ok=True)
        files.append(open(os.path.join(folder, name), "ab"))
        fcntl.flock(files[-1], fcntl.LOCK_EX | fcntl.LOCK_NB)
    return files


def wrong_answer(done, code, said, usual):
    """What is wrong with an exit code, and with what is said beside the usual; empty if nothing is."""
    if done.returncode != code:
        return f"exit code {done.returncode}: {done.stderr.strip()[:400]}"
    lines = [line for line in done.stderr.splitlines(keepends=True) if line not in usual]
    return "" if said.fullmatch("".join(lines)) else f"standard error: {done.stderr.strip()[:400]!r}"


def wrong_of(error, case, folder, expected, usual):
    """Of a work whose calls of flock() fail with the error."""
    begun(case, folder)
    done = run(folder, case.work.arguments, LD_PRELOAD=STUB, NYSALT_FLOCK=error)
    if error == "EWOULDBLOCK":
        return wrong_answer(done, 2, CONFLICT, usual)
    said = re.compile("") if error == "EINTR" else WARNING
    wrong = wrong_answer(done, 0, said, usual)
    return wrong or ("" if results(case, folder) == expected else "the files are others")


def wrong_of_held_lock(case, folder, usual, **environment):
    begun(case, folder)
    files = held(case, folder)
    done = run(folder, case.work.arguments, **environment)
    for file in files:
        file.close()
    return wrong_answer(done, 2, CONFLICT, usual)


def wrong_of_young_part(case, folder):
    """Of a file that was left just now, as of a process that still writes it."""
    begun(case, folder, age=0)
    done = run(folder, case.work.arguments, LD_PRELOAD=STUB, NYSALT_FLOCK="ENOSYS")
    code = 4 if done.returncode == 4 else 2  # 4: of the output, which is written last
    return wrong_answer(done, code, re.compile(WARNING.pattern + CONFLICT.pattern), "")


def main():
    shutil.rmtree(FOLDER, ignore_errors=True)
    os.makedirs(FOLDER)
    source = os.path.join(os.path.dirname(os.path.abspath(__file__)), "flock.c")
    subprocess.run([COMPILER, "-x", "c", "-O1", "-shared", "-fPIC", source, "-o", STUB, "-ldl"], check=True)
    folder = os.path.join(FOLDER, "here")
    tried = wrong = 0
    print("| output | errors tried | wrong |\n|---|---|---|")
    for case in cases():
        begun(case, folder)
        with_locks = run(folder, case.work.arguments)
        if with_locks.returncode == 2 and "built without" in with_locks.stderr:
            continue
        assert with_locks.returncode == 0 and "no locks" not in with_locks.stderr, (case.name, with_locks)
        expected = results(case, folder)
        assert expected and None not in expected.values(), (case.name, expected.keys())
        usual = with_locks.stderr
        shutil.rmtree(CACHE, ignore_errors=True)  # a system of the user is compiled again without locks
        attempts = {error: wrong_of(error, case, folder, expected, usual) for error in (*MISSING, "EWOULDBLOCK", "EINTR")}
        attempts["a lock that is held"] = wrong_of_held_lock(case, folder, usual)
        attempts["EINTR, and a lock that is held"] = wrong_of_held_lock(case, folder, usual, LD_PRELOAD=STUB, NYSALT_FLOCK="EINTR")
        if case.killed_at.startswith("rename"):
            attempts["a file that was left just now"] = wrong_of_young_part(case, folder)
        for error, what in attempts.items():
            if what:
                print(f"{case.name}, {error}: {what}", file=sys.stderr, flush=True)
        bad = sum(what != "" for what in attempts.values())
        print(f"| {case.name} | {len(attempts)} | {bad} |", flush=True)
        tried += len(attempts)
        wrong += bad
    # Where nothing is written, nothing is said.
    silent = run(FOLDER, RUN, LD_PRELOAD=STUB, NYSALT_FLOCK="ENOSYS")
    if silent.returncode != 0 or silent.stderr:
        wrong += 1
        print(f"run without an output: {silent.stderr}", file=sys.stderr)
    print(f"\n{tried + 1} runs, {wrong} wrong")
    return wrong > 0


if __name__ == "__main__":
    sys.exit(main())
