#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""An exported method in ASE itself: 108 atoms of argon, against ASE's own integrator at equal force evaluations.

usage: ase_test.py PROGRAM. Exit code 77 where there is no ASE.
"""
import importlib.util
import os
import subprocess
import sys
import tempfile

try:
    import numpy as np
    from ase import units
    from ase.build import bulk
    from ase.calculators.lj import LennardJones
    from ase.md.velocitydistribution import MaxwellBoltzmannDistribution
    from ase.md.verlet import VelocityVerlet
except ImportError as problem:
    print(f"skipped: {problem}")
    sys.exit(77)


def exported(method, folder):
    file = os.path.join(folder, method + ".py")
    subprocess.run([sys.argv[1], "export", method, "--to", "ase", "--output", file], check=True, stdout=subprocess.DEVNULL)
    spec = importlib.util.spec_from_file_location(method, file)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def run(dynamics, timestep, steps):
    """Calls of the force, and the deviation of the energy an atom in eV."""
    atoms = bulk("Ar", "fcc", a=5.4, cubic=True) * (3, 3, 3)
    atoms.calc = LennardJones(sigma=3.4, epsilon=0.0104, rc=8.0, smooth=True)
    MaxwellBoltzmannDistribution(atoms, temperature_K=60, rng=np.random.default_rng(1))
    calls = []
    calculate = atoms.calc.calculate
    atoms.calc.calculate = lambda *given, **named: (calls.append(1), calculate(*given, **named))
    moving = dynamics(atoms, timestep=timestep)
    energies = [atoms.get_total_energy()]
    for _ in range(steps):
        moving.run(1)
        energies.append(atoms.get_total_energy())
    return len(calls), np.std(energies) / len(atoms)


def main():
    with tempfile.TemporaryDirectory() as folder:
        module = exported("srkn6b", folder)
    assert module.self_test() < 1e-13
    h = 10 * units.fs
    calls, verlet = run(VelocityVerlet, h, 60)
    calls_of_ours, ours = run(module.srkn6b_dynamics, 6 * h, 10)
    print(f"{calls} and {calls_of_ours} forces: {verlet:.2e} eV an atom by VelocityVerlet, {ours:.2e} by srkn6b")
    assert calls == calls_of_ours == 61  # one for each kick, and that at the start
    assert ours < verlet / 50  # order 4 with small constants against order 2; some 300 was measured
    # A wrong coefficient is seen in the host too.
    wrong = list(module.COEFFICIENTS)
    wrong[2] += 1e-2
    wrong[4] -= 1e-2
    module.COEFFICIENTS = tuple(wrong)
    assert run(module.srkn6b_dynamics, 6 * h, 10)[1] > verlet / 50


if __name__ == "__main__":
    main()
