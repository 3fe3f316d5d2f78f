// SPDX-License-Identifier: BSL-1.0
// Export to BlackJAX.
#include "exported_method.hpp"
#include "exports.hpp"
#include "fill.hpp"

namespace nysalt::detail {

std::string export_to_blackjax(const exported_method& method) {
  const exported_letters word = composition_of(method, "BlackJAX");
  if (!is_palindrome(word) || word.letters.front() != 'B') {
    refuse_export(
        "export: the word for blackjax must be symmetric and begin with a kick, got {} with the letters {}; "
        "learn bab2 to bab6, or take mclachlan2v, bcss2v, bcss3 or bcss4",
        method.method.name(), word.letters);
  }
  auto values = values_of_header(method, "#");
  values.emplace_back("LIST", digits(word.coefficients));
  return fill(R"(@HEADER@#
# Coefficients of kicks and drifts in turn; a kick first and last, so that BlackJAX evaluates one gradient a drift.
#   blackjax.hmc(log_density, step_size, inverse_mass_matrix, integration_steps, integrator=integrator())
# Test, of a stand-in with the loop of BlackJAX: python3 FILE
COEFFICIENTS = [@LIST@]


def integrator():
    """For states of position and momentum: hmc, nuts."""
    from blackjax.mcmc.integrators import generate_euclidean_integrator
    return generate_euclidean_integrator(COEFFICIENTS)


def isokinetic_integrator():
    """For momenta on a sphere: mclmc and adjusted_mclmc."""
    from blackjax.mcmc.integrators import generate_isokinetic_integrator
    return generate_isokinetic_integrator(COEFFICIENTS)


def self_test():
    """By how much ten steps of two oscillators end elsewhere than nysalt's own: below 1e-13 by rounding."""
    def force(q):
        return [-q[0] - 2 * q[0] * q[1], -q[1] - q[0] ** 2 + q[1] ** 2]

    q, p, inverse_mass, h = [0.3, 0.2], [0.1, -0.25], [1.0, 0.5], 0.1
    f = force(q)
    for _ in range(10):
        for i, c in enumerate(COEFFICIENTS):
            if i % 2 == 0:
                p = [p[k] + c * h * f[k] for k in range(2)]
            else:
                q = [q[k] + c * h * inverse_mass[k] * p[k] for k in range(2)]
                f = force(q)
    return max(abs(a - b) for a, b in zip(q + p, [@Q@, @P@]))


@MAIN@)",
              values);
}

}  // namespace nysalt::detail
