#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""Learned words in LAMMPS, on a crystal of 108 atoms, against LAMMPS's own integrators at equal force evaluations.

usage: lammps.py PROGRAM FOLDER [--seeds N]

Writes FOLDER/hosts.md: deviations of the energy with words without a bath, and errors of the mean potential energy with
words in a bath. The words are learned for clusters of 13 atoms and for a chain of springs with the crystal's highest
frequency, and taken to the crystal, as one would.
"""
import argparse
import math
import os
import pathlib
import statistics
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "tests/long/hosts"))
import common  # noqa: E402
import lammps_test as host  # noqa: E402

CRYSTAL = """units lj
atom_style atomic
atom_modify map array
lattice fcc 1.06
region box block 0 3 0 3 0 3
create_box 1 box
create_atoms 1 box
mass 1 1.0
pair_style lj/gromacs 2.1 2.4
pair_coeff 1 1 1.0 1.0
neighbor 0.3 bin
neigh_modify delay 0 every 1 check yes
velocity all create {twice} {seed} mom yes rot no
thermo_modify norm no
"""
TEMPERATURE = 0.1


def learned(folder, name, *options):
    file = os.path.join(folder, name + ".json")
    if not os.path.exists(file):
        subprocess.run([common.PROGRAM, "learn", *options, "--output", file], check=True, stdout=subprocess.DEVNULL)
    return file


def run(driver, lines, seed, folder):
    """Numbers that the script prints to `found`, one row a line."""
    host.run(driver, CRYSTAL.format(twice=2 * TEMPERATURE, seed=seed) + "\n".join(lines) + "\n", folder)
    with open(os.path.join(folder, "found")) as file:
        return [[float(one) for one in line.split()] for line in file if not line.startswith("#")]


def mean_and_error(numbers):
    return statistics.mean(numbers), statistics.stdev(numbers) / math.sqrt(len(numbers))


def energies(driver, fix, timestep, stages, seed, folder):
    """The deviation of the energy an atom from the mean, and its drift over the run, looked at every `stages` forces."""
    forces = 12000  # a multiple of 1 to 6
    rows = run(driver, ["fix warm all nve", "timestep 0.005", "run 2000", "unfix warm", "reset_timestep 0", fix, f"timestep {timestep}",
                        "variable e equal etotal",
                        f"fix out all print {stages} \"$(v_e:%.17g)\" file found screen no title \"\"", f"run {forces}"],
               seed, folder)
    values = [row[0] / 108 for row in rows if row]
    tenth = len(values) // 10
    return statistics.pstdev(values), statistics.mean(values[-tenth:]) - statistics.mean(values[:tenth])


def potential_energy(driver, fixes, timestep, stages, seed, time, folder):
    """The mean potential energy an atom in a bath, of all looks every `stages` forces."""
    warm = int(round(20.0 / timestep / stages)) * stages
    long = int(round(time / timestep / stages)) * stages
    rows = run(driver, [*(one.format(seed=seed) for one in fixes), f"timestep {timestep}", "compute u all pe",
                        f"run {warm}", "reset_timestep 0", "variable u equal c_u",
                        f"fix mean all ave/time {stages} {long // stages} {long} v_u file found format \" %.17g\"",
                        f"run {long}"], seed, folder)
    return rows[-1][-1] / 108


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("folder")
    parser.add_argument("--seeds", type=int, default=8)
    asked = parser.parse_args()
    folder = os.path.abspath(asked.folder)
    os.makedirs(folder, exist_ok=True)
    drivers = {}

    def driver_of(method):
        if method not in drivers:
            own = os.path.join(folder, f"driver_{len(drivers)}")
            os.makedirs(own, exist_ok=True)
            drivers[method] = host.compiled(method, own)
        return drivers[method]

    seeds = range(1, asked.seeds + 1)
    page = ["# Learned words in a host", "",
            "LAMMPS of 2022 (Debian 12), 108 atoms of Lennard and Jones in a periodic crystal (density 1.06, kT = 0.1, smooth cut-off",
            "2.1 to 2.4), each row with as many force evaluations as the others of its table.",
            f"`bench/studies/hosts/lammps.py` wrote this, with {asked.seeds} seeds a row.", "",
            "## Energy, without a bath", "",
            "Deviation of the energy of an atom along 12000 force evaluations after 2000 to warm up, and its drift from the first tenth to",
            "the last. `bab3 learned` and `bab6 learned` are of `nysalt learn --system lennard_jones --space 3 --atoms 13 --spread 1.5",
            "--loss energy` at the step of three and six forces.", "",
            "| time a force | method | deviation | drift |", "|---|---|---|---|"]
    for timestep in (0.005, 0.0075, 0.01):
        words = [(f"{family} learned", learned(
            folder, f"{family}_{timestep}", "--system", "lennard_jones", "--space", "3", "--atoms", "13",
            "--spread", "1.5", "--family", family, "--step", repr(round(stages * timestep, 6)), "--loss", "energy",
            "--trajectories", "16"), stages) for family, stages in (("bab3", 3), ("bab6", 6))]
        for name, method, stages in (("fix nve", None, 1), ("bcss3 exported", "bcss3", 3), ("srkn6b exported", "srkn6b", 6),
                                     *words):
            driver = driver_of(method or "verlet")
            fix = "fix 1 all nysalt/exported" if method else "fix 1 all nve"
            found = [energies(driver, fix, timestep, stages, seed, folder) for seed in seeds]
            deviation, off = mean_and_error([one[0] for one in found])
            drift, drift_off = mean_and_error([one[1] for one in found])
            page.append(f"| {timestep} | {name} | {deviation:.2e} ± {off:.0e} | {drift:.1e} ± {drift_off:.0e} |")
            print(page[-1], flush=True)
    page += ["", "## Configurations, in a bath of friction 1", "",
             "Mean potential energy of an atom less that of `baoab` at a time of 0.002 a force. `bab3 learned` is of `nysalt learn --system",
             "linear_chain --masses 8 --spring 225 --friction 1 --temperature 0.1 --placement middle --family bab3 --loss covariance` at the",
             "step of three forces: a chain whose highest frequency, 30, is near that of the crystal.", "",
             "| time a force | method | error |", "|---|---|---|"]
    time = 400.0
    bath = f"fix 1 all nysalt/exported {TEMPERATURE} 1.0 {{seed}}"
    exact = [potential_energy(driver_of("baoab"), [bath], 0.002, 1, 100 + seed, time, folder) for seed in seeds]
    truth, truth_off = mean_and_error(exact)
    page.append(f"| 0.002 | baoab exported | {truth:.5f} ± {truth_off:.0e} itself |")
    print(page[-1], flush=True)
    for timestep in (0.01, 0.02, 0.03, 0.04):
        word = learned(folder, f"bath_{timestep}", "--system", "linear_chain", "--masses", "8", "--spring", "225",
                       "--friction", "1", "--temperature", str(TEMPERATURE), "--placement", "middle", "--family", "bab3",
                       "--step", repr(3 * timestep), "--loss", "covariance")
        langevin = f"fix 2 all langevin {TEMPERATURE} {TEMPERATURE} 1.0 {{seed}}"
        for name, method, stages, fixes in (("fix nve, fix langevin", "verlet", 1, ["fix 1 all nve", langevin]),
                                            ("the same with gjf", "verlet", 1, [langevin + " gjf vhalf", "fix 1 all nve"]),
                                            ("baoab exported", "baoab", 1, [bath]), ("bab3 learned", word, 3, [bath])):
            found = [potential_energy(driver_of(method), fixes, timestep, stages, seed, time, folder) for seed in seeds]
            mean, off = mean_and_error(found)
            page.append(f"| {timestep} | {name} | {mean - truth:+.5f} ± {math.hypot(off, truth_off):.0e} |")
            print(page[-1], flush=True)
    with open(os.path.join(folder, "hosts.md"), "w") as file:
        file.write("\n".join(page) + "\n")


if __name__ == "__main__":
    main()
