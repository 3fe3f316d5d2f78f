#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""An exported method in ASE itself: 108 atoms of argon, against ASE's own integrator at equal force evaluations.

usage: ase_test.py PROGRAM. Exit code 77 where there is no ASE.
"""
import sys
import tempfile

try:
    import numpy as np
    import nysalt
    from ase import Atoms, units
    from ase.build import bulk
    from ase.constraints import FixBondLength
    from ase.calculators.lj import LennardJones
    from ase.md.velocitydistribution import MaxwellBoltzmannDistribution
    from ase.md.verlet import VelocityVerlet
    from common import exported_module
except ImportError as problem:
    print(f"skipped: {problem}")
    sys.exit(77)


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


# [calculator]
def system_of(atoms, name, temperature_K=60):
    """Atoms with a calculator as a system: positions, momenta and energies in the units of ASE."""
    at_rest, masses = atoms.get_positions().ravel(), np.repeat(atoms.get_masses(), 3)

    def potential(q):
        atoms.set_positions(q.reshape(-1, 3))
        return atoms.get_potential_energy()

    def force(q):
        atoms.set_positions(q.reshape(-1, 3))
        return atoms.get_forces().ravel()

    def starts(seed, n):
        normal = np.random.default_rng([seed, n]).normal(size=len(masses))
        return at_rest, np.sqrt(masses * units.kB * temperature_K) * normal

    return nysalt.hamiltonian(name, dimension=len(masses), potential=potential, force=force, starts=starts,
                              inverse_mass=1 / masses)
# [/calculator]


def four_atoms():
    a = 3.4 * 2 ** (1 / 6) / np.sqrt(2)
    atoms = Atoms("ArArArAr", positions=a * np.array([[0, 0, 0], [1, 1, 0], [1, 0, 1], [0, 1, 1]]))
    atoms.calc = LennardJones(sigma=3.4, epsilon=0.0104, rc=20.0)
    return atoms


def test_a_calculator_is_a_system(folder):
    """ASE's forces under nysalt's stepper, and nysalt's coefficients in ASE: the same trajectory."""
    system = system_of(four_atoms(), "four_argon_atoms")
    q, p = (np.array(x) for x in system.starts(1))
    h = 30 * units.fs
    there = nysalt.integrate(system, "srkn6b", h, q, p, 20)
    atoms = four_atoms()
    atoms.set_momenta(p.reshape(-1, 3))
    moving = exported_module("srkn6b", "ase", folder).srkn6b_dynamics(atoms, timestep=h)
    moving.run(20)
    off = np.abs(atoms.get_positions().ravel() - there[0]).max()
    print(f"a calculator as a system: off by {off:.1e} A, moved by {np.abs(there[0] - q).max():.1e}")
    assert off < 1e-11 and np.abs(there[0] - q).max() > 0.1  # some 1000 roundings of numbers below 10


def test_a_constraint_and_a_bath(folder):
    atoms = four_atoms()
    atoms.set_constraint(FixBondLength(0, 1))
    MaxwellBoltzmannDistribution(atoms, temperature_K=30, rng=np.random.default_rng(2))
    apart = atoms.get_distance(0, 1)
    energy = atoms.get_total_energy()
    exported_module("srkn6b", "ase", folder).srkn6b_dynamics(atoms, timestep=12 * units.fs).run(100)
    print(f"constrained: {atoms.get_distance(0, 1) - apart:.1e} A, {atoms.get_total_energy() - energy:.1e} eV")
    assert abs(atoms.get_distance(0, 1) - apart) < 1e-8  # RATTLE in ASE stops at 1e-13 of squares
    assert abs(atoms.get_total_energy() - energy) < 1e-6
    # Free atoms in a bath have its temperature; 600 momenta, looked at 50 times some relaxation times apart.
    free = Atoms("Ar200", positions=np.random.default_rng(1).uniform(0, 1e4, (200, 3)))
    free.calc = LennardJones(sigma=3.4, epsilon=0.0104, rc=5.0)
    moving = exported_module("baoab", "ase", folder).baoab_dynamics(free, timestep=100 * units.fs, temperature_K=90,
                                                      friction=0.02 / units.fs, rng=np.random.default_rng(7))
    found = []
    for _ in range(50):
        moving.run(1)
        found.append(free.get_temperature())
    mean = np.mean(found[10:])
    print(f"bath: {mean:.2f} K of 90")
    assert abs(mean - 90) < 5 * 90 * np.sqrt(2 / (600 * 40 * 0.5))


def main():
    with tempfile.TemporaryDirectory() as folder:
        test_a_calculator_is_a_system(folder)
        test_a_constraint_and_a_bath(folder)
    with tempfile.TemporaryDirectory() as folder:
        module = exported_module("srkn6b", "ase", folder)
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
