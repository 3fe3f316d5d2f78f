// SPDX-License-Identifier: BSL-1.0
// Export to OpenMM.
#include "exports.hpp"
#include "fill.hpp"

namespace nysalt::detail {

std::string export_to_openmm(const exported_method& method) {
  if (method.method.letters().is_processed()) {
    refuse_export(
        "export: the method for openmm, whose CustomIntegrator has no copy of the state, must have no "
        "processor, got {}; export to c, cpp, fortran, python or julia, or take the method without the "
        "processor",
        method.method.name());
  }
  auto values = values_of(method, "#");
  add_bath(values, method,
           {{"BATH_ARGUMENTS", ", friction=1 / unit.picosecond, temperature=300 * unit.kelvin"},
            {"BATH_PARAMETER", ", friction, temperature"},
            {"BATH_GLOBALS", R"py(
    made.addGlobalVariable("friction", friction)
    made.addGlobalVariable("kT", unit.MOLAR_GAS_CONSTANT_R * temperature))py"},
            {"BATH_BRANCH", R"py(        elif letter == "O":
            damping = f"friction*({next(c)})*dt"
            integrator.addComputePerDof(
                "v", f"exp(-({damping}))*v + sqrt((1 - exp(-2*({damping})))*kT/m)*gaussian")
            if constrained:
                integrator.addConstrainVelocities()
)py"},
            {"BATH_PINNED", ", friction=1.5, kT=0.7"}});
  return fill(R"py(@HEADER@#
@EXPLAINED@
# A CustomIntegrator of OpenMM; dt is that of all letters together. Forces are calculated again only where positions
# have changed. With constraints each drift is followed by the constraints of positions, and each kick by those of
# velocities; constrained=False leaves these lines out.
#   from openmm import unit
#   integrator = @NAME@_integrator(2 * unit.femtoseconds@BATH_ARGUMENTS@)
# Test, of a stand-in that computes the statements: python3 FILE
import math

LETTERS = "@KERNEL@"
COEFFICIENTS = (@KERNEL_COEFFICIENTS@,)


def @NAME@_integrator(dt@BATH_PARAMETER@, constrained=True):
    from openmm import CustomIntegrator, unit
    made = CustomIntegrator(dt)@BATH_GLOBALS@
    add_statements(made, constrained)
    return made


def add_statements(integrator, constrained=True):
    """The letters as statements of a CustomIntegrator."""
    for name in ["x1"] * constrained + ["x0"] * ("D" in LETTERS):
        integrator.addPerDofVariable(name, 0)
    integrator.addUpdateContextState()
    c = iter(COEFFICIENTS)
    for letter in LETTERS:
        if letter == "A":
            a = next(c)
            integrator.addComputePerDof("x", f"x + ({a})*dt*v")
            if constrained:
                integrator.addComputePerDof("x1", "x")
                integrator.addConstrainPositions()
                integrator.addComputePerDof("v", f"v + (x - x1)/(({a})*dt)")
@BATH_BRANCH@        else:
            b = next(c)
            if letter == "D":
                integrator.addComputePerDof("x0", "x")
                integrator.addComputePerDof("x", f"x + ({next(c)})*dt*dt*f/m")
            integrator.addComputePerDof("v", f"v + ({b})*dt*f/m")
            if letter == "D":
                integrator.addComputePerDof("x", "x0")
            if constrained:
                integrator.addConstrainVelocities()


class _TwoOscillators:
    """Computes statements as OpenMM does, without constraints; the forces wherever they are asked for."""

    def __init__(self):
        self.x, self.v, self.statements, self.drawn = [0.3, 0.2], [0.1, -0.125], [], 0

    def addPerDofVariable(self, name, value):
        setattr(self, name, [value, value])

    def addComputePerDof(self, name, expression):
        self.statements.append((name, compile(expression, expression, "eval")))

    def addUpdateContextState(self):
        pass

    addConstrainPositions = addConstrainVelocities = addUpdateContextState

    def step(self, dt):
        for name, expression in self.statements:
            x, y = self.x
            forces = [-x - 2 * x * y, -y - x**2 + y**2]
            found = []
            for i, m in enumerate([1.0, 2.0]):
                self.drawn += "gaussian" in expression.co_names
                known = {one: value[i] for one, value in vars(self).items() if one in ("x", "v", "x0", "x1")}
                found.append(eval(expression, dict(
                    known, f=forces[i], m=m, dt=dt, gaussian=math.sin(self.drawn), exp=math.exp, sqrt=math.sqrt@BATH_PINNED@)))
            setattr(self, name, found)


def self_test():
    """By how much ten steps of two oscillators end elsewhere than nysalt's own: below 1e-13 by rounding."""
    run = _TwoOscillators()
    add_statements(run)
    for _ in range(10):
        run.step(0.1)
    end = run.x + [run.v[0], 2 * run.v[1]]
    return max(abs(a - b) for a, b in zip(end, [@Q@, @P@]))


@MAIN@)py",
              values);
}

}  // namespace nysalt::detail
