// SPDX-License-Identifier: BSL-1.0
// Export to Mici.
#include "exported_method.hpp"
#include "exports.hpp"
#include "fill.hpp"

namespace nysalt::detail {

std::string export_to_mici(const exported_method& method) {
  const exported_letters word = composition_of(method, "Mici");
  if (!is_palindrome(word) || word.letters.size() < 3) {
    refuse_export(
        "export: the word for mici must be symmetric, of drifts and kicks, got {} with the letters {}; learn "
        "a symmetric family, bab2 to bab6 or aba4 to aba6",
        method.method.name(), word.letters);
  }
  // Its list of free coefficients leaves out one of either kind at the centre, which follow from the sums.
  const std::size_t half = (word.letters.size() + 1) / 2;
  const std::vector<double> free(word.coefficients.begin(),
                                 word.coefficients.begin() + static_cast<std::ptrdiff_t>(half - 2));
  auto values = values_of_header(method, "#");
  values.emplace_back("LIST", digits(free) + (free.size() == 1 ? "," : ""));
  values.emplace_back("FIRST", word.letters.front() == 'B' ? "True" : "False");
  return fill(R"(@HEADER@#
# The free coefficients of a symmetric composition: the others follow from symmetry and from sums of one.
# Test, of a stand-in with the loop of Mici: python3 FILE
FREE_COEFFICIENTS = (@LIST@)
BEGINS_WITH_KICK = @FIRST@


def integrator(system, step_size):
    from mici.integrators import SymmetricCompositionIntegrator
    return SymmetricCompositionIntegrator(system, FREE_COEFFICIENTS, step_size=step_size,
                                          initial_h1_flow_step=BEGINS_WITH_KICK)


def coefficients():
    """All of them, as Mici completes them: the kinds alternate, and each kind sums to one."""
    free, n = list(FREE_COEFFICIENTS), len(FREE_COEFFICIENTS)
    free.append(0.5 - sum(free[n % 2::2]))
    free.append(1.0 - 2.0 * sum(free[(n + 1) % 2:n + 1:2]))
    return free + free[-2::-1]


def self_test():
    """By how much ten steps of two oscillators end elsewhere than nysalt's own: below 1e-13 by rounding."""
    def force(q):
        return [-q[0] - 2 * q[0] * q[1], -q[1] - q[0] ** 2 + q[1] ** 2]

    q, p, inverse_mass, h = [0.3, 0.2], [0.1, -0.25], [1.0, 0.5], 0.1
    for _ in range(10):
        for i, c in enumerate(coefficients()):
            if (i % 2 == 0) == BEGINS_WITH_KICK:
                f = force(q)
                p = [p[k] + c * h * f[k] for k in range(2)]
            else:
                q = [q[k] + c * h * inverse_mass[k] * p[k] for k in range(2)]
    return max(abs(a - b) for a, b in zip(q + p, [@Q@, @P@]))


@MAIN@)",
              values);
}

}  // namespace nysalt::detail
