# SPDX-License-Identifier: BSL-1.0
"""What the studies of this folder ask of the program, and of who runs them."""
import argparse
import json
import os
import subprocess
import sys

BUNDLED = ("oscillator", "linear_chain", "fpu", "henon_heiles", "pendulum", "kepler", "phi4", "lennard_jones")


def ask(program, *arguments):
    """The document of a command, its exit code, and what it said on standard error."""
    done = subprocess.run([program, *map(str, arguments), "--json"], capture_output=True, text=True, check=False)
    try:
        return json.loads(done.stdout), done.returncode, done.stderr.strip()
    except json.JSONDecodeError:
        return None, done.returncode, done.stderr.strip()


def highest_frequency(program, *system):
    """The highest frequency along the motion of a system, given by options; None if it is not known."""
    document, _, said = ask(program, "stability", *system, "--method", "verlet", "--step", 1e-3)
    if document is None:
        sys.exit(f"{' '.join(map(str, system))}: {said}")
    return document["judgement"]["highest_frequency"]


def asked_for(description, what, **further):
    """The command line, with a list of families or of methods and further options; makes the folder."""
    parser = argparse.ArgumentParser(description=description.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("folder")
    parser.add_argument("--systems", default=",".join(BUNDLED))
    parser.add_argument("--" + what)
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    for name, default in further.items():
        parser.add_argument("--" + name, default=default)
    asked = parser.parse_args()
    os.makedirs(asked.folder, exist_ok=True)
    return asked
