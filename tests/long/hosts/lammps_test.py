#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""Exported fixes in LAMMPS itself: seven atoms end where nysalt's own steps do, and a bath has its temperature.

usage: lammps_test.py PROGRAM. Exit code 77 where there is no LAMMPS with its headers.
"""
import os
import shutil
import subprocess
import sys
import tempfile

from common import ATOMS, HERE, export, of_nysalt, off


def compiled(method, folder):
    """A program that runs scripts with the fix nysalt/exported."""
    text = os.path.join(folder, "exported.hpp")
    export(method, "lammps", text, "--name", "exported")
    driver = os.path.join(folder, "driver")
    flags = subprocess.run(["mpicxx", "--showme:compile"], check=True, capture_output=True, text=True).stdout.split()
    links = subprocess.run(["mpicxx", "--showme:link"], check=True, capture_output=True, text=True).stdout.split()
    subprocess.run(["g++", "-O1", "-std=c++17", *flags, "-I/usr/include/lammps", f'-DEXPORTED="{text}"',
                    os.path.join(HERE, "lammps_driver.cpp"), "-o", driver, *links, "-llammps"], check=True)
    return driver


def script(start, lines):
    """Atoms in free space, with all pairs within the cut-off."""
    q, p = start[:3 * ATOMS], start[3 * ATOMS:]
    text = ["units lj", "atom_style atomic", "atom_modify map array sort 0 0", "boundary f f f",
            "region box block -20 20 -20 20 -20 20", "create_box 1 box"]
    text += ["create_atoms 1 single " + " ".join(map(repr, q[3 * i:3 * i + 3])) for i in range(ATOMS)]
    text += ["mass 1 1.0", "pair_style lj/cut 15.0", "pair_coeff 1 1 1.0 1.0", "neighbor 1.0 bin", "comm_modify cutoff 18"]
    for i in range(ATOMS):
        text += [f"set atom {i + 1} v{x} {p[3 * i + k]!r}" for k, x in enumerate("xyz")]
    return "\n".join(text + lines) + "\n"


def run(driver, text, folder):
    with open(os.path.join(folder, "script"), "w") as file:
        file.write(text)
    subprocess.run([driver, "script"], check=True, cwd=folder)


def end_in_lammps(driver, start, stages, h, steps, folder):
    run(driver, script(start, ["fix 1 all nysalt/exported", f"timestep {h / stages!r}", f"run {stages * steps}",
                               "write_dump all custom end id x y z vx vy vz modify format float %.17g sort id"]), folder)
    with open(os.path.join(folder, "end")) as file:
        rows = [[float(one) for one in line.split()] for line in file if len(line.split()) == 7 and line[0].isdigit()]
    return [x for row in rows for x in row[1:4]] + [v for row in rows for v in row[4:7]]


def test_equality(folder):
    for method, stages in (("verlet", 1), ("mclachlan2v", 2), ("srkn6b", 6)):
        driver = compiled(method, folder)
        h = 0.01 * stages
        start, end = of_nysalt(method, h, 10, folder)
        found = end_in_lammps(driver, start, stages, h, 10, folder)
        print(f"{method}: off by {off(found, end):.1e}, moved by {off(start, end):.1e}")
        # Some 100 sums of forces below 100 in another order, each rounded to 2^-53, in steps of 0.01.
        assert off(found, end) < 1e-13 and off(start, end) > 1e-2
        # Another step is another trajectory.
        assert off(end_in_lammps(driver, start, stages, 1.001 * h, 10, folder), end) > 1e-6


def test_bath(folder):
    """Free atoms in a bath: the mean of v^2 is kT/m, and the seed decides all."""
    driver = compiled("baoab", folder)

    def temperature(seed, temperature=0.7):
        text = f"""units lj
atom_style atomic
lattice sc 0.001
region box block 0 10 0 10 0 10
create_box 1 box
create_atoms 1 box
mass 1 2.0
pair_style zero 1.0
pair_coeff * *
fix 1 all nysalt/exported {temperature} 1.0 {seed}
timestep 0.5
thermo_modify norm no
run 20
variable t equal temp
print "$(v_t:%.17g)" file found screen no
"""
        run(driver, text, folder)
        with open(os.path.join(folder, "found")) as file:
            return float(file.read())

    found = [temperature(seed) for seed in range(1, 9)]
    mean = sum(found) / len(found)
    # 8 times 3000 squares of normal numbers after 10 relaxation times: the mean has the deviation .7 sqrt(2/24000);
    # LAMMPS counts three degrees of freedom less in 3000.
    print(f"bath: {mean:.4f}, asked for 0.7")
    assert abs(mean * 2997 / 3000 - 0.7) < 4 * 0.7 * (2 / 24000) ** 0.5
    assert temperature(1) == found[0] and len(set(found)) == len(found)
    assert abs(temperature(1, 1.4) / found[0] - 2) < 1e-9  # the same numbers, from rest


def main():
    if shutil.which("mpicxx") is None or not os.path.exists("/usr/include/lammps/library.h"):
        print("skipped: there are no headers of LAMMPS")
        sys.exit(77)
    with tempfile.TemporaryDirectory() as folder:
        test_equality(folder)
        test_bath(folder)


if __name__ == "__main__":
    main()
