// SPDX-License-Identifier: BSL-1.0
// Export to ASE, the Atomic Simulation Environment.
#include "exported_method.hpp"
#include "exports.hpp"
#include "fill.hpp"

namespace nysalt::detail {

std::string export_to_ase(const exported_method& method) {
  const exported_letters word = composition_in_bath_of(method, "ASE");
  auto values = values_of_header(method, "#");
  values.emplace_back("LETTERS", word.letters);
  values.emplace_back("LIST", digits(word.coefficients));
  add_bath(
      values, method,
      {{"BATH_ARGUMENTS", ",\n#                                 temperature_K=300, friction=0.01 / units.fs"},
       {"BATH_IMPORT", "    from ase.units import kB\n"},
       {"BATH_STANDS_IN", "    kB = 1.0\n"},
       {"BATH_PARAMETER", ", temperature_K, friction"},
       {"BATH_RANDOM", ", rng=np.random"},
       {"BATH_HELD", R"(
        self.temperature, self.friction, self.rng = kB * temperature_K, friction, rng)"},
       {"BATH_BRANCH", R"(            elif letter == "O":
                damping = self.friction * c * h
                noise = np.sqrt(-np.expm1(-2 * damping) * self.temperature * masses)
                atoms.set_momenta(np.exp(-damping) * atoms.get_momenta()
                                  + noise * self.rng.standard_normal((len(masses), 3)))
)"},
       {"BATH_PINNED", R"(
class _Sines:
    """What step() asks of a generator: sin(1), sin(2), ... for the first coordinate of each atom."""

    drawn = 0

    def standard_normal(self, shape):
        self.drawn += shape[0]
        return np.sin(np.arange(self.drawn - shape[0] + 1, self.drawn + 1))[:, np.newaxis]

)"},
       {"BATH_TEST", "    run.temperature, run.friction, run.rng = 0.7, 1.5, _Sines()\n"}});
  return fill(R"(@HEADER@#
@EXPLAINED@
# A dynamics of ASE, in the units of ASE. Forces that the calculator has are not calculated again, also from step to step.
# After a drift with constraints the momenta become those of the constrained motion.
#   from ase import units
#   dynamics = @NAME@_dynamics(atoms, timestep=2 * units.fs@BATH_ARGUMENTS@)
#   dynamics.run(1000)
# Test, with a stand-in for the atoms: python3 FILE
import numpy as np

try:
    from ase.md.md import MolecularDynamics
@BATH_IMPORT@except ImportError:  # for the self-test only
    MolecularDynamics = object
@BATH_STANDS_IN@
LETTERS = "@LETTERS@"
COEFFICIENTS = (@LIST@,)


class @NAME@_dynamics(MolecularDynamics):
    """The method; the timestep is that of all letters together."""

    def __init__(self, atoms, timestep@BATH_PARAMETER@, trajectory=None, logfile=None, loginterval=1@BATH_RANDOM@):
        super().__init__(atoms, timestep, trajectory, logfile, loginterval)@BATH_HELD@

    def step(self, forces=None):
        atoms, h = self.atoms, self.dt
        masses = atoms.get_masses()[:, np.newaxis]
        for letter, c in zip(LETTERS, COEFFICIENTS):
            if letter == "A":
                before = atoms.get_positions()
                atoms.set_positions(before + c * h * atoms.get_momenta() / masses)
                if atoms.constraints:
                    atoms.set_momenta((atoms.get_positions() - before) * masses / (c * h), apply_constraint=False)
@BATH_BRANCH@            else:
                atoms.set_momenta(atoms.get_momenta() + c * h * atoms.get_forces(md=True))
        return atoms.get_forces(md=True)


class _TwoOscillators:
    """What step() asks of atoms."""

    constraints = ()

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

@BATH_PINNED@
def self_test():
    """By how much ten steps of two oscillators end elsewhere than nysalt's own: below 1e-13 by rounding."""
    run = @NAME@_dynamics.__new__(@NAME@_dynamics)
    run.atoms, run.dt = _TwoOscillators(), 0.1
@BATH_TEST@    for _ in range(10):
        run.step()
    return max(np.abs(run.atoms.q[:, 0] - [@Q@]).max(),
               np.abs(run.atoms.p[:, 0] - [@P@]).max())


@MAIN@)",
              values);
}

}  // namespace nysalt::detail
