// SPDX-License-Identifier: BSL-1.0
// Export to Python with NumPy.
#include "exports.hpp"
#include "fill.hpp"

namespace nysalt::detail {

std::string export_to_python(const exported_method& method) {
  auto values = values_of(method, "#");
  add_bath(
      values, method,
      {{"BATH_NONE", ", bath=None"},
       {"BATH_PARAMETER", ", *, friction, temperature, normal"},
       {"BATH_SENTENCE",
        "\n\n    The temperature is kT; normal(shape) is an array of standard normal numbers: "
        "rng.standard_normal."},
       {"BATH", ", (friction, temperature, normal)"},
       {"BATH_BRANCH", R"(        if letter == "O":
            friction, temperature, normal = bath
            damping = friction * next(c) * h
            p *= np.exp(-damping)
            p += np.sqrt(-np.expm1(-2 * damping) * temperature / inverse_mass) * normal(p.shape)
            continue
)"},
       {"BATH_PINNED", "    sines = iter(np.sin(np.arange(1, 1000)))\n"},
       {"BATH_TEST",
        ",\n          friction=1.5, temperature=0.7, normal=lambda shape: np.array([next(sines) for _ in "
        "range(*shape)])"}});
  return fill(R"(@HEADER@#
@EXPLAINED@
# A run is start once, steps, and finish on a copy of q and p that is observed; without a processor start and finish do
# nothing. A force that is known is not evaluated again, also from step to step.
# Test: python3 FILE
import numpy as np

KERNEL = "@KERNEL@", (@KERNEL_COEFFICIENTS@,)
START = "@START@", (@START_COEFFICIENTS@,)
FINISH = "@FINISH@", (@FINISH_COEFFICIENTS@,)


def apply(word, q, p, h, force, inverse_mass, f=None@BATH_NONE@):
    """One pass over the letters of a word, in place; the force at q where it is known, else None."""
    letters, coefficients = word
    c = iter(coefficients)
    for letter in letters:
        if letter == "A":
            q += next(c) * h * inverse_mass * p
            f = None
            continue
@BATH_BRANCH@        if f is None:
            f = force(q)
        if letter == "B":
            p += next(c) * h * f
        else:
            b = next(c)
            p += b * h * force(q + next(c) * h * h * inverse_mass * f)
    return f


def start(q, p, h, force, inverse_mass=1.0):
    apply(START, q, p, h, force, inverse_mass)


def steps(q, p, h, count, force, inverse_mass=1.0@BATH_PARAMETER@):
    """`count` steps of length h of the arrays q and p, in place; force(q) is an array of their shape.@BATH_SENTENCE@"""
    f = None
    for _ in range(count):
        f = apply(KERNEL, q, p, h, force, inverse_mass, f@BATH@)


def finish(q, p, h, force, inverse_mass=1.0):
    apply(FINISH, q, p, h, force, inverse_mass)


def self_test():
    """By how much ten steps of two oscillators end elsewhere than nysalt's own: below 1e-13 by rounding."""
    def force(q):
        return np.array([-q[0] - 2 * q[0] * q[1], -q[1] - q[0] ** 2 + q[1] ** 2])

    q, p, inverse_mass = np.array([0.3, 0.2]), np.array([0.1, -0.25]), np.array([1.0, 0.5])
@BATH_PINNED@    start(q, p, 0.1, force, inverse_mass)
    steps(q, p, 0.1, 10, force, inverse_mass@BATH_TEST@)
    finish(q, p, 0.1, force, inverse_mass)
    return max(np.abs(q - [@Q@]).max(), np.abs(p - [@P@]).max())


@MAIN@)",
              values);
}

}  // namespace nysalt::detail
