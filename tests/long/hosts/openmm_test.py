#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""Statements of exported integrators in OpenMM itself, whose Python Debian 12 has not: seven atoms end where nysalt's own
steps do, a constraint holds, and a bath has its temperature.

usage: openmm_test.py PROGRAM. Exit code 77 where there is no OpenMM with its headers.
"""
import os
import subprocess
import sys
import tempfile

from common import ATOMS, HERE, exported_module, of_nysalt, off


class Recorder:
    """Writes the calls of a CustomIntegrator down."""

    def __init__(self):
        self.lines = []

    def __getattr__(self, method):
        return lambda *words: self.lines.append("\t".join([method, *map(str, words)]))


def statements(method, folder, constrained):
    recorder = Recorder()
    exported_module(method, "openmm", folder, "--name", "exported").add_statements(recorder, constrained)
    return recorder.lines


def run(driver, atoms, mass, constrained, h, steps, lines, friction=0.0, kT=0.0, seed=1):
    head = f"{len(atoms)} {mass} {int(constrained)} {h!r} {steps} {friction} {kT} {seed}\n"
    rows = "".join(" ".join(map(repr, atom)) + "\n" for atom in atoms)
    done = subprocess.run([driver], input=head + rows + "\n".join(lines) + "\n", check=True, capture_output=True, text=True)
    return [[float(one) for one in line.split()] for line in done.stdout.splitlines()]


def atoms_of(start):
    q, p = start[:3 * ATOMS], start[3 * ATOMS:]
    return [q[3 * i:3 * i + 3] + p[3 * i:3 * i + 3] for i in range(ATOMS)]


def flat(rows):
    return [x for row in rows for x in row[:3]] + [v for row in rows for v in row[3:]]


def distance(rows):
    return sum((a - b) ** 2 for a, b in zip(rows[0][:3], rows[1][:3])) ** 0.5


def main():
    with tempfile.TemporaryDirectory() as folder:
        driver = os.path.join(folder, "driver")
        built = subprocess.run(["g++", "-O1", "-std=c++17", os.path.join(HERE, "openmm_driver.cpp"), "-o", driver, "-lOpenMM"],
                               capture_output=True, text=True)
        if built.returncode != 0:
            if "OpenMM.h: No such file" in built.stderr:
                print("skipped: there are no headers of OpenMM")
                sys.exit(77)
            sys.exit(built.stderr)
        for method in ("verlet", "srkn6b", "mclachlan5"):
            start, end = of_nysalt(method, 0.05, 10, folder)
            found = flat(run(driver, atoms_of(start), 1.0, False, 0.05, 10, statements(method, folder, False))[:ATOMS])
            print(f"{method}: off by {off(found, end):.1e}, moved by {off(start, end):.1e}")
            # Some 100 sums of forces below 100 in another order, each rounded to 2^-53, in steps of 0.05.
            assert off(found, end) < 1e-12 and off(start, end) > 1e-1
        # With a constraint the distance stays, and the energy as well as the method keeps it: order 4 by halved steps.
        energies = []
        for steps in (20, 40):
            lines = statements("srkn6b", folder, True)
            atoms = atoms_of(start)
            rest = run(driver, atoms, 1.0, True, 1e-9, 1, lines)
            there = run(driver, atoms, 1.0, True, 1.0 / steps, steps, lines)
            assert abs(distance(there) - distance(atoms)) < 1e-10
            energies.append(abs(there[-1][0] - rest[-1][0]))
        print(f"constrained: energy off by {energies[0]:.1e}, and by {energies[1]:.1e} with half the step")
        free = run(driver, atoms, 1.0, False, 0.05, 20, statements("srkn6b", folder, False))
        assert abs(distance(free) - distance(atoms)) > 1e-3  # without the constraint it does not stay
        assert energies[1] < energies[0] / 3  # at least of order 2
        # Oscillators of frequency 1 in a bath: BAOAB has their positions exactly, at any step.
        found = run(driver, [[0.0] * 6] * 50, 1.0, False, 1.0, 4000, statements("baoab", folder, True), 1.0, 0.7, 3)[0]
        # 50 x 3 x 4000 values, independent after some two steps: the mean square has the deviation .7 sqrt(2/300000).
        print(f"bath: <x^2> = {found[0]:.4f} of 0.7, <m v^2> = {found[1]:.4f}")
        assert abs(found[0] - 0.7) < 5 * 0.7 * (2 / 300000) ** 0.5
        # Velocities at the end of a step are those of a smaller temperature, by 1 - h^2/4.
        assert abs(found[1] - 0.7 * 0.75) < 0.02


if __name__ == "__main__":
    main()
