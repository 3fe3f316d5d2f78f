// SPDX-License-Identifier: BSL-1.0
// Export to ASE, the Atomic Simulation Environment.
#include "composition.hpp"
#include "exports.hpp"
#include "fill.hpp"

namespace nysalt::program {

std::string export_to_ase(const exported_method& method) {
  const exported_letters word = composition_of(method, "ASE");
  const self_test end = self_test_of(method);
  return fill(R"(@HEADER@#
# A dynamics of ASE, in the units of ASE: letters act from left to right, A(a) is q += a dt p/m, B(b) is p += b dt f(q).
# Forces that the calculator has are not calculated again, also from step to step.
#   from ase import units
#   dynamics = @NAME@_dynamics(atoms, timestep=2 * units.fs)
#   dynamics.run(1000)
# Test, with a stand-in for the atoms: python3 FILE
import numpy as np

try:
    from ase.md.md import MolecularDynamics
except ImportError:  # for the self-test alone
    MolecularDynamics = object

LETTERS = "@LETTERS@"
COEFFICIENTS = (@LIST@,)


class @NAME@_dynamics(MolecularDynamics):
    """The method at constant energy; the timestep is that of all letters together."""

    def __init__(self, atoms, timestep, trajectory=None, logfile=None, loginterval=1):
        super().__init__(atoms, timestep, trajectory, logfile, loginterval)

    def step(self, forces=None):
        atoms, h = self.atoms, self.dt
        masses = atoms.get_masses()[:, np.newaxis]
        for letter, c in zip(LETTERS, COEFFICIENTS):
            if letter == "A":
                atoms.set_positions(atoms.get_positions() + c * h * atoms.get_momenta() / masses)
            else:
                atoms.set_momenta(atoms.get_momenta() + c * h * atoms.get_forces(md=True))
        return atoms.get_forces(md=True)


class _TwoOscillators:
    """What step() asks of atoms."""

    def __init__(self):
        self.q, self.p = np.array([[0.3], [0.2]]), np.array([[0.1], [-0.25]])

    def get_masses(self):
        return np.array([1.0, 2.0])

    def get_positions(self):
        return self.q.copy()

    def set_positions(self, q):
        self.q = q.copy()

    def get_momenta(self):
        return self.p.copy()

    def set_momenta(self, p):
        self.p = p.copy()

    def get_forces(self, md=False):
        (x,), (y,) = self.q
        return np.array([[-x - 2 * x * y], [-y - x**2 + y**2]])


def self_test():
    """By how much ten steps of two oscillators end elsewhere than nysalt's own: below 1e-13 by rounding."""
    run = @NAME@_dynamics.__new__(@NAME@_dynamics)
    run.atoms, run.dt = _TwoOscillators(), 0.1
    for _ in range(10):
        run.step()
    return max(np.abs(run.atoms.q[:, 0] - [@Q@]).max(),
               np.abs(run.atoms.p[:, 0] - [@P@]).max())


if __name__ == "__main__":
    off = self_test()
    print(f"@NAME@: off by {off:.1e}")
    raise SystemExit(not off < 1e-13)
)",
              {{"NAME", method.name},
               {"HEADER", header(method, "#")},
               {"LETTERS", word.letters},
               {"LIST", digits(word.coefficients)},
               {"Q", digits(end.q)},
               {"P", digits(end.p)}});
}

}  // namespace nysalt::program
