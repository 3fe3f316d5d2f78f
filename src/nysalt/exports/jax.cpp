// SPDX-License-Identifier: BSL-1.0
// Export to JAX.
#include "exports.hpp"
#include "fill.hpp"

namespace nysalt::detail {

std::string export_to_jax(const exported_method& method) {
  if (method.method.letters().is_processed()) {
    refuse_export(
        "export: the method for jax must have no processor, got {}; export to c, cpp, fortran, python or "
        "julia, or take the method without the processor",
        method.method.name());
  }
  auto values = values_of(method, "#");
  const std::string& letters = method.method.letters().letters();
  const bool ends_known = letters.find_last_of("BD") != std::string::npos &&
                          (letters.find_last_of('A') == std::string::npos ||
                           letters.find_last_of('A') < letters.find_last_of("BD"));
  values.emplace_back("CARRIES", ends_known ? "True" : "False");
  add_bath(values, method,
           {{"BATH_PARAMETER", ", *, key, friction, temperature, normal=None"},
            {"BATH_SENTENCE",
             "\n\n    The temperature is kT; key is a new one for each step. normal(key, shape) is "
             "jax.random.normal."},
            {"BATH_KEYS", R"(    if normal is None:
        from jax.random import normal, split
        keys = iter(split(key, LETTERS.count("O")))
    else:
        keys = iter([key] * LETTERS.count("O"))
)"},
            {"BATH_BRANCH", R"(        elif letter == "O":
            damping = friction * next(c) * h
            spread = jnp.sqrt(-jnp.expm1(-2 * damping) * temperature / inverse_mass)
            p = jnp.exp(-damping) * p + spread * normal(next(keys), p.shape)
)"},
            {"BATH_PINNED", R"(    drawn = iter(range(1, 1000))
)"},
            {"BATH_TEST",
             ",\n                     key=None, friction=1.5, temperature=0.7,\n                     "
             "normal=lambda key, shape: np.array([np.sin(next(drawn)) for _ in range(*shape)])"}});
  return fill(R"(@HEADER@#
@EXPLAINED@
# A step as a pure function, for jit, scan, vmap and grad; shift(q, dq) moves positions, in periodic boxes too
# (the shift_fn of jax-md). A force that is known is not evaluated again, also from step to step.
# Test, with NumPy where there is no JAX: python3 FILE
import numpy as np

try:
    import jax.numpy as jnp
except ImportError:  # for the self-test only
    jnp = np

LETTERS = "@KERNEL@"
COEFFICIENTS = (@KERNEL_COEFFICIENTS@,)
CARRIES_FORCE = @CARRIES@  # no drift comes after the last kick


def init(q, p, force):
    """The state of a run: positions, momenta, and the force at the positions."""
    return q, p, force(q)


def step(state, h, force, inverse_mass=1.0, shift=lambda q, dq: q + dq@BATH_PARAMETER@):
    """The state one step later.@BATH_SENTENCE@"""
    q, p, f = state
@BATH_KEYS@    known = CARRIES_FORCE
    c = iter(COEFFICIENTS)
    for letter in LETTERS:
        if letter == "A":
            q = shift(q, next(c) * h * inverse_mass * p)
            known = False
@BATH_BRANCH@        else:
            f = f if known else force(q)
            known = True
            b = next(c)
            if letter == "B":
                p = p + b * h * f
            else:
                p = p + b * h * force(shift(q, next(c) * h * h * inverse_mass * f))
    return q, p, f


def self_test():
    """By how much ten steps of two oscillators end elsewhere than nysalt's own: below 1e-13 by rounding."""
    if jnp is not np:
        from jax import config
        config.update("jax_enable_x64", True)

    def force(q):
        return jnp.array([-q[0] - 2 * q[0] * q[1], -q[1] - q[0] ** 2 + q[1] ** 2])

@BATH_PINNED@    state = init(jnp.array([0.3, 0.2]), jnp.array([0.1, -0.25]), force)
    for _ in range(10):
        state = step(state, 0.1, force, jnp.array([1.0, 0.5])@BATH_TEST@)
    return float(max(abs(state[0] - jnp.array([@Q@])).max(), abs(state[1] - jnp.array([@P@])).max()))


@MAIN@)",
              values);
}

}  // namespace nysalt::detail
