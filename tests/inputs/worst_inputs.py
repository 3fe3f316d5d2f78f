#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""The worst inputs of each kind that the program reads: done or refused, within 10 s and 1 GB.

usage: worst_inputs.py PROGRAM FOLDER [--some] [--instrumented]; the exit status is 1 if a promise was broken

Each kind of file and of text is made large, deep, endless and strange. The program must end with the exit code 0, 2 or
3, a refusal with one line of at most 2,000 bytes, within 10 s of CPU time and 1 GB of memory; a source that is compiled
may take 30 s, as the compiler alone takes 5 to 12 s of one that is right. Prints a table. --some: one file of each kind.
--instrumented: the program is built with sanitizers or counts its lines, and gets ten times the seconds and three times
the memory: AddressSanitizer pads what is allocated and keeps what was freed.
"""
import json
import os
import resource
import shutil
import subprocess
import sys
import time
import zlib

PROGRAM = os.path.abspath(sys.argv[1])
FOLDER = os.path.abspath(sys.argv[2])
SOME = "--some" in sys.argv
INSTRUMENTED = "--instrumented" in sys.argv
SECONDS = 100 if INSTRUMENTED else 10
MEGABYTES = 3000 if INSTRUMENTED else 1000

MB = 1 << 20
TEXTS = {
    "zeros": lambda: "\0" * MB,
    "digits": lambda: "1" * MB,
    "brackets": lambda: "[" * MB,
    "braces": lambda: '{"a":' * (MB // 5),
    "parentheses": lambda: "(" * (MB // 2) + "x" + ")" * (MB // 2),
    "numbers": lambda: ",".join("0.5" for _ in range(MB // 4)),
    "lines": lambda: "\n" * MB,
    "quotes": lambda: '"' * MB,
    "names": lambda: "\n".join(f"a{i} = {i}" for i in range(MB // 16)),
    "no UTF-8": lambda: "\xff\xfe" * (MB // 2),
    "large": lambda: "q1,q2,q3,q4,q5,q6\n" + "1,2,3,4,5,6\n" * (100 * MB // 12),
    "endless": None,  # /dev/zero
}
FPU = ["--system", "fpu"]
COMPARE = ["compare", *FPU, "--methods", "verlet", "--steps", "0.01", "--trajectories", "2", "--horizon", "0.1", "--threads",
           "1", "--output", "race"]
WORK = "race/report.work"
WORK_OF_RUN = "out.csv.work"
RUN = ["run", "--method", "verlet", "--step", "0.01", "--horizon", "0.1", "--threads", "1"]


def commands_of_file(name):
    """Each kind of file that the program reads, as (kind, arguments)."""
    yield "options", ["--config", name, *RUN, *FPU]
    yield "method", ["run", *FPU, "--method", name, "--step", "0.01", "--horizon", "0.1", "--threads", "1"]
    yield "method in a race", ["compare", *FPU, "--methods", f"verlet,{name}", "--steps", "0.1", "--trajectories", "2", "--threads", "1"]
    yield "method to export", ["export", name, "--to", "c"]
    yield "template", ["export", "verlet", "--template", name]
    yield "stability", ["stability", "--method", name]
    yield "starts", [*RUN, *FPU, "--start", name]
    yield "data", [*RUN, "--system", "logistic_regression", "--data", name]
    yield "state", [*RUN, *FPU, "--output", "out.csv", "--resume"]
    yield "system", [*RUN, "--system", name]
    yield "report", ["cite", name]
    yield "work", [*COMPARE, "--resume"]


ENDINGS = {"options": ".toml", "starts": ".csv", "data": ".csv", "system": ".hpp", "report": ".json"}
PLACES = {"work": WORK, "state": WORK_OF_RUN}  # of files that have one name


def commands_of_text():
    """Texts and numbers on the command line."""
    shorter = 100_000  # a word of the command line has 128 kB at most
    texts = {
        "parentheses": "(" * (shorter // 2) + "x" + ")" * (shorter // 2),
        "sum": "+".join(["x"] * (shorter // 2)),
        "power": "^".join(["x"] * (shorter // 2)),
        "minus": "-" * shorter + "x",
        "functions": "sin(" * (shorter // 5) + "x" + ")" * (shorter // 5),
        "digits": "1" * shorter,
        "commas": "," * shorter,
        "numbers": ",".join(["0.01"] * (shorter // 5)),
        "names": ",".join(f"v{i}" for i in range(shorter // 7)),
    }
    for name, text in texts.items():
        yield f"potential, {name}", [*RUN, "--potential", text, "--variables", "x"]
        yield f"parameters, {name}", [*RUN, "--potential", "k*x^2", "--variables", "x", "--parameter", text]
        yield f"variables, {name}", [*RUN, "--potential", "x^2", "--variables", text]
        yield f"methods, {name}", ["compare", *FPU, "--methods", text, "--steps", "0.1", "--trajectories", "2", "--threads", "1"]
        yield f"steps, {name}", ["compare", *FPU, "--methods", "verlet", "--steps", text, "--trajectories", "2", "--horizon", "0.1", "--threads", "1"]
        yield f"observables, {name}", [*RUN, *FPU, "--observables", text]
        yield f"step, {name}", ["run", *FPU, "--method", "verlet", "--step", text, "--horizon", "1", "--threads", "1"]
    for number in ("1000000000000000000", "9223372036854775807", "1e308", "100000000", "300000"):
        for system, option in (("fpu", "--pairs"), ("linear_chain", "--masses"), ("phi4", "--masses"),
                               ("lennard_jones", "--atoms"), ("lennard_jones_liquid", "--atoms"),
                               ("phi4_lattice", "--side"), ("gaussian", "--size")):
            yield f"{system} {option} {number}", [*RUN, "--system", system, option, number]
        if float(number) > 2**48:  # fewer are what is asked for, if it takes a day
            yield f"trajectories {number}", [*RUN, *FPU, "--trajectories", number, "--observables", "energy"]
        yield f"variables q[{number}]", [*RUN, "--potential", "0.5*sum(q^2)", "--variables", f"q[{number}]"]

OPTIONS_OF_LISTS = ("steps", "levels", "methods", "metric", "prices", "range", "fix", "variables")  # of compare


def long_and_right():
    """Files that are right, but long: (kind, ending, text, arguments before the name of the file).

    Of steps what reads and checks the list is timed: the horizon is shorter than a step, as runs at all of them take long.
    """
    short = ["--trajectories", "2", "--horizon", "0.1", "--threads", "1"]
    for many in (4_900, 100_000):  # nearly as many dots as a file may have, and too many
        steps = ",".join(f"0.{100000 + i}" for i in range(many))
        yield "steps", ".toml", f"steps = [{steps}]\n", ["compare", *FPU, "--methods", "verlet", *short, "--config"]
        yield "steps", ".toml", f"steps = [{steps}]\n", ["learn", *FPU, "--family", "bab2", *short, "--config"]
    for lines in (1, 7, 8):  # of the shortest values, in a file of nearly a megabyte, and in one too long
        text = "".join(f"{name} = [{','.join('1' * 65_000)}]\n" for name in OPTIONS_OF_LISTS[:lines])
        yield "steps", ".toml", text, ["compare", *FPU, *short, "--config"]
    cells = 1 << 22  # of a table, at most
    for starts in (
        "q1,q2,q3,q4,q5,q6\n" + "0.125,0.25,0.5,0.125,0.25,0.5\n" * (cells // 6 - 1),
        "q1,q2,q3,q4,q5,q6\n" + "0.125,0.25,0.5,0.125,0.25,0.5\n" * (63 * MB // 30),  # as long as may be
        "q1,q2,q3,q4,q5,q6" + "".join(f",{i}" for i in range(cells // 2 - 6)) + "\n" + "0.125,0.25,0.5,0.125,0.25,0.5" + "," * (cells // 2 - 6) + "\n",
        "q1,q2,q3,q4,q5,q6" + "," * (60 * MB) + "\n",
    ):
        yield "starts", ".csv", starts, [*RUN, *FPU, "--start"]
    of_one = [*RUN, "--system", "pendulum", "--start"]
    yield "starts", ".csv", "q1\n" + "1\n" * (cells - 1), of_one
    yield "starts", ".csv", "q1\n" + "1\n" * (31 * MB), of_one
    columns = ",".join(f"q{1 + i}" for i in range(500_000)) + "\n" + ",".join(["0"] * 500_000) + "\n"
    yield "starts", ".csv", columns, [*RUN, "--system", "phi4", "--masses", "500000", "--start"]
    for data in (
        "a,b,c,label\n" + "0.125,0.25,1.5,1\n0.25,0.5,2.5,0\n" * (60 * MB // 32),
        "a,label\n" + "1,1\n0,0\n" * (8 * MB),
        "a,label\n" + "1,1\n0,0\n" * (cells // 4 - 1),
        *(",".join(f"c{i}" for i in range(columns)) + "\n" + (",".join(["1"] * columns) + "\n" + ",".join(["0"] * columns) + "\n") * (rows // 2)
          for columns, rows in ((20_001, 600), (20_001, 200), (2_000, 2_000), (200_000, 18), (200, 20_000))),
    ):
        yield "data", ".csv", data, [*RUN, "--system", "logistic_regression", "--data"]
    yield "data", ".csv", ",".join(f"c{i}" for i in range(3000)) + "\n" + (",".join(["1", "0"] * 1500) + "\n") * 20, [
        *RUN, "--system", "logistic_regression", "--data"]


def work_files_at_bounds():
    """Work files that the program wrote, edited until they are as large as may be read: (kind, name, path, writer, arguments)."""
    quiet = {"cwd": FOLDER, "stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    for old in (WORK, WORK_OF_RUN):
        if os.path.lexists(os.path.join(FOLDER, old)):
            os.remove(os.path.join(FOLDER, old))
    shutil.rmtree(os.path.join(FOLDER, "race"), ignore_errors=True)
    # Where the report cannot be written, as it is too large, the work file stays.
    too_small = 16 * 1024  # for a report of 60 kB
    subprocess.run([PROGRAM, *COMPARE], check=False, preexec_fn=lambda: resource.setrlimit(
        resource.RLIMIT_FSIZE, (too_small, too_small)), **quiet)
    kept_run = [*RUN, *FPU, "--output", "out.csv", "--keep-work"]
    subprocess.run([PROGRAM, *kept_run], check=True, **quiet)
    with open(os.path.join(FOLDER, WORK), encoding="utf-8") as file:
        head, *parts = file.read().splitlines()
    shutil.rmtree(os.path.join(FOLDER, "race"))
    with open(os.path.join(FOLDER, WORK_OF_RUN), "rb") as file:
        head_of_run, _, state = (file.readline().decode().rstrip("\n") for _ in range(3))

    most = 1 << 22  # values of one document

    def signed(document):
        bare = {name: value for name, value in document.items() if name != "checksum"}
        text = json.dumps(bare, separators=(",", ":"))
        return f'{text[:-1]},"checksum":"crc32:{zlib.crc32(text.encode()):08x}"}}'

    def part(result):
        return signed({**json.loads(parts[-1]), "result": result})

    def work(*lines, head=head, numbers=0):
        """A function that writes a work file to a path, with zeros for numbers (a sparse file)."""
        def write(path):
            os.makedirs(os.path.dirname(path), exist_ok=True)
            end = 0
            for _ in range(numbers * 8 // MB):
                end = zlib.crc32(bytes(MB), end)
            of_numbers = [signed({"part": "numbers", "result": [numbers, end]})] if numbers else []
            with open(path, "w", encoding="utf-8") as file:
                file.write("\n".join([head, *of_numbers, *lines]) + ("\n\n" if numbers else "\n"))
                file.truncate(file.tell() + numbers * 8)
        return write

    numbers = [0.1] * (most - 100)
    texts = ["0123456789" * 6] * (60 * MB // 64)
    names = {f"n{i}": 1 for i in range(20_000)}
    for name, lines in {
        "the longest list": [part(numbers)],
        "the longest texts": [part(texts)],
        "the most members": [part(names)],
        "four of the longest parts": [part(texts)] * 4,
        "four of the longest lists": [part([1] * (most - 100))] * 4,
        "the most parts": [signed({"part": f"p{i}", "result": 1}) for i in range(100_000)],
    }.items():
        yield "work", name, WORK, work(*lines), [*COMPARE, "--resume"]
    found = json.loads(state)["result"]
    for name, more, count in (
        ("the most numbers", {}, 1 << 27),
        ("the most trajectories", {"wave": [None] * (most - 1000)}, 1 << 20),
        ("the most diverged trajectories", {"diverged": [{"trajectory": 0, "step": 0}] * (most // 6)}, 0),
    ):
        one = signed({"part": "state", "result": {**found, "finished": False, "step": 0, **more}})
        yield "state", name, WORK_OF_RUN, work(one, head=head_of_run, numbers=count), [*kept_run, "--resume"]


def limit():
    os.setsid()
    resource.setrlimit(resource.RLIMIT_CPU, (3 * SECONDS + 1, 3 * SECONDS + 2))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def attempt(arguments, most_seconds):
    """(what is wrong or "", exit code, seconds, megabytes) of one command."""
    started = time.monotonic()
    with open(os.path.join(FOLDER, "out"), "wb") as out, open(os.path.join(FOLDER, "err"), "wb") as err:
        child = subprocess.Popen([PROGRAM, *arguments], cwd=FOLDER, stdout=out, stderr=err, stdin=subprocess.DEVNULL,
                                 preexec_fn=limit)
        peak = 0
        while True:
            done, status, usage = os.wait4(child.pid, os.WNOHANG)
            if done:
                break
            if time.monotonic() - started > 6 * SECONDS:
                os.killpg(child.pid, 9)
            time.sleep(0.002)
    child.returncode = os.waitstatus_to_exitcode(status)
    seconds = usage.ru_utime + usage.ru_stime
    peak = usage.ru_maxrss / 1024
    with open(os.path.join(FOLDER, "err"), "rb") as file:
        said = file.read()
    wrong = ""
    if child.returncode not in (0, 2, 3):
        wrong = f"exit code {child.returncode}"
    elif seconds > most_seconds:
        wrong = f"{seconds:.1f} s"
    elif peak > MEGABYTES:
        wrong = f"{peak:.0f} MB"
    elif child.returncode == 2 and (said.count(b"\n") != 1 or not said.startswith(b"nysalt: ")):
        wrong = "the refusal is not one line"
    elif child.returncode == 2 and len(said) > 2000:
        wrong = f"a refusal of {len(said)} bytes"
    return wrong, child.returncode, seconds, peak


def main():
    shutil.rmtree(FOLDER, ignore_errors=True)
    os.makedirs(FOLDER)
    rows, wrong = {}, 0

    def note(kind, name, arguments):
        nonlocal wrong
        problem, code, seconds, peak = attempt(arguments, 3 * SECONDS if kind == "system" else SECONDS)
        row = rows.setdefault(kind, [0, 0, 0.0, 0.0, 0])
        row[0] += 1
        row[1] += code == 2
        row[2] = max(row[2], seconds)
        row[3] = max(row[3], peak)
        if problem:
            row[4] += 1
            wrong += 1
            shown = [one if len(one) < 60 else one[:57] + "..." for one in arguments]
            print(f"{kind}, {name}: {problem}: {' '.join(shown)}", file=sys.stderr, flush=True)

    os.makedirs(os.path.join(FOLDER, os.path.dirname(WORK)))
    for name, text in list(TEXTS.items())[:1 if SOME else None]:
        for kind, _ in commands_of_file(""):
            path = "/dev/zero"
            if text is not None:
                path = PLACES.get(kind, "input" + ENDINGS.get(kind, ".json"))
                with open(os.path.join(FOLDER, path), "w", encoding="latin-1") as file:
                    file.write(text())
            elif kind in ("system", "work", "state"):
                path = PLACES.get(kind, "zero.hpp")
                if os.path.exists(os.path.join(FOLDER, path)):
                    os.remove(os.path.join(FOLDER, path))
                os.symlink("/dev/zero", os.path.join(FOLDER, path))
            arguments = next(words for one, words in commands_of_file(path) if one == kind)
            note(kind, name, arguments)
    for kind, ending, text, arguments in [] if SOME else long_and_right():
        path = f"long{ending}"
        with open(os.path.join(FOLDER, path), "w", encoding="utf-8") as file:
            file.write(text)
        note(kind, "long and right", [*arguments, path])
    for kind, name, path, write, arguments in [] if SOME else work_files_at_bounds():
        write(os.path.join(FOLDER, path))
        note(kind, name, arguments)
    for kind, arguments in [] if SOME else commands_of_text():
        note(kind.split(",")[0].split(" ")[0], kind, arguments)
    print("| kind of input | tried | refused | slowest, s | largest, MB | wrong |\n|---|---|---|---|---|---|")
    for kind, (tried, refused, seconds, peak, bad) in rows.items():
        print(f"| {kind} | {tried} | {refused} | {seconds:.1f} | {peak:.0f} | {bad} |")
    print(f"\n{sum(row[0] for row in rows.values())} inputs tried, {wrong} wrong")
    return wrong > 0


if __name__ == "__main__":
    sys.exit(main())
