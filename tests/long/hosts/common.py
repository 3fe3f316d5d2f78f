# SPDX-License-Identifier: BSL-1.0
"""What the tests of hosts share: texts of exported methods, and where nysalt itself goes."""
import csv
import importlib.util
import os
import subprocess
import sys

PROGRAM = os.path.abspath(sys.argv[1])
HERE = os.path.dirname(os.path.abspath(__file__))
ATOMS = 7


def export(method, host, file, *options):
    subprocess.run([PROGRAM, "export", method, "--to", host, "--output", file, *options], check=True, stdout=subprocess.DEVNULL)


def exported_module(method, host, folder, *options):
    file = os.path.join(folder, method + ".py")
    export(method, host, file, *options)
    spec = importlib.util.spec_from_file_location(method, file)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def of_nysalt(method, h, steps, folder):
    """Start and end of a trajectory, positions before momenta."""
    names = [f"{x}{i + 1}" for x in "qp" for i in range(3 * ATOMS)]
    file = os.path.join(folder, "here.csv")
    subprocess.run([PROGRAM, "run", "--system", "lennard_jones", "--space", "3", "--atoms", str(ATOMS), "--method", method,
                    "--step", repr(h), "--horizon", repr(h * steps), "--trajectories", "1", "--sample-every", str(steps),
                    "--observables", ",".join(names), "--output", file], check=True, stdout=subprocess.DEVNULL)
    with open(file) as rows:
        return [[float(one) for one in row[3:]] for row in list(csv.reader(rows))[2:]]


def off(a, b):
    return max(abs(x - y) for x, y in zip(a, b))
