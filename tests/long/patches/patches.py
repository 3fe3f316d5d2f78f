#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""A letter, a host of exports, a loss and an option of a command, each added to a copy of the sources by a small patch, and used.

usage: patches.py FOLDER SOURCE OPTION...   copies the sources to FOLDER, applies the patches that stand beside this file,
                                            builds the program with the OPTIONs of cmake, and uses what was added
       patches.py FOLDER --program PROGRAM  uses a program as it is
The exit status is 1 if a patch changes more files than it may, or if what was added does not work.
"""
import json
import math
import os
import re
import shutil
import subprocess
import sys

HERE = os.path.dirname(os.path.realpath(__file__))
MOST_FILES = {"letter": 2, "host": 1, "loss": 2, "option": 1}


def require(condition, text):
    if not condition:
        raise RuntimeError(text)


def output_of(command, **options):
    done = subprocess.run(command, capture_output=True, text=True, check=False, **options)
    if done.returncode != 0:
        lines = (done.stdout + done.stderr).splitlines()[-40:]
        raise RuntimeError(f"exit code {done.returncode}: " + "\n".join(lines))
    return done.stdout


# ---- The copy.

def copy_sources(source, copy):
    names = output_of(["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"], cwd=source).split("\0")
    for name in filter(None, names):
        if os.path.isfile(os.path.join(source, name)):  # it may have been removed
            os.makedirs(os.path.dirname(os.path.join(copy, name)), exist_ok=True)
            shutil.copy2(os.path.join(source, name), os.path.join(copy, name))


def apply_patches(copy):
    # The copy may stand inside another repository, where git would look for the files of that one.
    outside = {**os.environ, "GIT_CEILING_DIRECTORIES": os.path.dirname(copy)}
    outside.pop("GIT_DIR", None)
    for name, most in MOST_FILES.items():
        patch = os.path.join(HERE, f"{name}.patch")
        files = output_of(["git", "apply", "--numstat", patch], cwd=copy, env=outside).splitlines()
        require(0 < len(files) <= most, f"{name}.patch may change {most} files, it changes {len(files)}")
        output_of(["git", "apply", patch], cwd=copy, env=outside)
        print(f"{name}.patch: {len(files)} files", flush=True)


def built_program(folder, source, options):
    copy, build = os.path.join(folder, "source"), os.path.join(folder, "build")
    shutil.rmtree(copy, ignore_errors=True)
    shutil.rmtree(build, ignore_errors=True)
    copy_sources(source, copy)
    apply_patches(copy)
    without = [f"-DNYSALT_{what}=OFF" for what in ("BUILD_TESTS", "BUILD_EXAMPLES", "BUILD_BENCH")]
    output_of(["cmake", "-S", copy, "-B", build, *without, *options])
    has_python = "nysalt_python:" in output_of(["cmake", "--build", build, "--target", "help"])
    targets = ["nysalt_program", *(["nysalt_python"] if has_python else [])]
    output_of(["cmake", "--build", build, "--target", *targets, "--parallel", str(os.cpu_count())])
    return os.path.join(build, "nysalt")


# ---- What was added, through the program.

class Uses:
    def __init__(self, program, folder):
        self.program = program
        self.folder = folder

    def run(self, *arguments):
        return output_of([self.program, *arguments], cwd=self.folder,
                         env={**os.environ, "XDG_CACHE_HOME": os.path.join(self.folder, "cache")})

    def write_table(self, file, letters, coefficients):
        table = {"format": "nysalt table", "version": 1, "letters": letters, "coefficients": coefficients}
        with open(os.path.join(self.folder, file), "w", encoding="utf-8") as out:
            json.dump(table, out)

    def samples(self, *arguments):
        """The observables of all samples of a run, a row for each."""
        lines = self.run("run", "--no-checks", *arguments).splitlines()
        rows = [line for line in lines if not line.startswith("#")][1:]
        return [[float(number) for number in row.split(",")[3:]] for row in rows]

    def phase_error(self, method, step):
        """Of an oscillation, relative. q_0 + q_2 = 2 cos(phase) q_1 for every linear map of determinant 1."""
        q = [row[0] for row in self.samples("--system", "oscillator", "--omega", "1", "--at", "q1=1", "--method", method,
                                            "--step", str(step), "--horizon", str(2 * step), "--observables", "q1")]
        require(len(q) == 3, f"3 samples are due, got {len(q)}")
        return abs(math.acos((q[0] + q[2]) / (2 * q[1])) / step - 1)

    def letter(self):
        """T is D(c, 1/12), alone and in lanes; the order that it states of phases is 4, and 2 is that of Verlet's method."""
        self.write_table("ata.json", "ATA", [0.5, 1.0, 0.5])
        self.write_table("ada.json", "ADA", [0.5, 1.0, 1.0 / 12.0, 0.5])
        run = ("--system", "henon_heiles", "--step", "0.1", "--horizon", "5", "--trajectories", "13", "--observables",
               "q1,q2,p1,p2,energy", "--method")
        found, expected = self.samples(*run, "ata.json"), self.samples(*run, "ada.json")
        require(len(found) == len(expected) == 13 * 51, f"{13 * 51} samples are due, got {len(found)}")
        off = max(abs(a - b) for row, other in zip(found, expected) for a, b in zip(row, other))
        require(off < 1e-13, f"states of ATA are off by {off:.1e}")
        for method, order in (("ata.json", 4), ("verlet_aba", 2)):
            ratio = self.phase_error(method, 0.4) / self.phase_error(method, 0.2)
            require(abs(math.log2(ratio) - order) < 0.1, f"phases of {method} must have the order {order}: "
                                                         f"half the step divides their error by {ratio:.3g}")
        chart = json.loads(self.run("stability", "--method", "ata.json", "--json"))
        require(chart["order"] == 2 and chart["evaluations_per_step"] == 2, f"order and evaluations: {chart}")
        require(abs(chart["limit"] - math.sqrt(12)) < 1e-9, f"ATA is stable up to the root of 12, got {chart['limit']}")

    def host(self):
        for method in ("verlet", "pefrl"):
            text = self.run("export", method, "--to", "awk")
            require(f"function {method}_step(" in text, f"this is no step of {method}:\n{text}")
            if shutil.which("awk"):
                with open(os.path.join(self.folder, "step.awk"), "w", encoding="utf-8") as out:
                    out.write(text)
                output_of(["awk", "-f", "step.awk"], cwd=self.folder)  # its self-test

    def loss(self):
        on_system = ("--system", "henon_heiles", "--step", "0.5")
        self.run("learn", *on_system, "--family", "bab2", "--loss", "energies", "--trajectories", "16", "--effort", "quick",
                 "--output", "scheme.json")
        with open(os.path.join(self.folder, "scheme.json"), encoding="utf-8") as file:
            scheme = json.load(file)
        require(scheme["objective"] == "energies", f"the scheme was learned by the loss {scheme['objective']}")
        b = scheme["parameters"]["b1"]
        require(0.1 < b < 0.3, f"b1 is {b}")
        require(len(self.samples(*on_system, "--horizon", "5", "--method", "scheme.json")) == 11, "11 samples are due")

    def option(self):
        """In the help, the table of the document, the signature of Python and the types: all are made from one row."""
        self.run("run", "--system", "pendulum", "--method", "verlet", "--step", "0.1", "--horizon", "1", "--echoes", "2")
        require("  --echoes N [3]" in self.run("run", "--help"), "the help must have the option and its default")
        source = os.path.join(os.path.dirname(self.folder), "source")
        update = (sys.executable, "-B", os.path.join(source, "docs", "site", "options.py"), self.program)
        output_of([*update, "--update"])
        with open(os.path.join(source, "docs", "program.md"), encoding="utf-8") as file:
            require("\n| `--echoes N [3]` | a number of no use |\n" in file.read(), "the table must have the option")
        package = os.path.join(os.path.dirname(self.program), "python")
        if os.path.isdir(os.path.join(package, "nysalt")):
            environment = {**os.environ, "PYTHONPATH": package}
            with open(os.path.join(os.path.dirname(self.program), "CMakeCache.txt"), encoding="utf-8") as file:
                python = re.search(r"^NYSALT_MODULE_PYTHON:\w+=(.+)$", file.read(), re.MULTILINE)[1]
            read = "import inspect, nysalt; print(inspect.signature(nysalt.run).parameters['echoes'])"
            found = output_of([python, "-B", "-c", read], env=environment)
            require(found.replace("'", "") == "echoes: int = 3\n", f"the signature has {found}")
            stub = os.path.join(source, "docs", "site", "stub.py")
            output_of([python, "-B", stub, "--update"], env=environment)
            with open(os.path.join(source, "python", "nysalt", "__init__.pyi"), encoding="utf-8") as file:
                require("echoes: int=..." in file.read(), "the types must have the option")


def main():
    folder = os.path.realpath(sys.argv[1])
    if sys.argv[2] == "--program":
        program = os.path.realpath(sys.argv[3])
    else:
        program = built_program(folder, os.path.realpath(sys.argv[2]), sys.argv[3:])
    work = os.path.join(folder, "work")
    shutil.rmtree(work, ignore_errors=True)
    os.makedirs(work)
    uses = Uses(program, work)
    wrong = 0
    for name in MOST_FILES:
        try:
            getattr(uses, name)()
            print(f"{name}: works")
        except (RuntimeError, ValueError, KeyError) as problem:
            print(f"{name}: {problem}")
            wrong += 1
    print(f"{len(MOST_FILES)} patches tried, {wrong} do not work")
    return wrong > 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except RuntimeError as problem:
        sys.exit(f"patches.py: {problem}")
