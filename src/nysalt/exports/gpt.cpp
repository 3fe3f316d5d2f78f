// SPDX-License-Identifier: BSL-1.0
// Export to GPT, the Grid Python Toolkit.
#include "exported_method.hpp"
#include "exports.hpp"
#include "fill.hpp"

namespace nysalt::detail {

std::string export_to_gpt(const exported_method& method) {
  const exported_letters word = composition_of(method, "GPT");
  if (!is_palindrome(word)) {
    refuse_export(
        "export: the word for gpt must be symmetric, of drifts and kicks, got {} with the letters {}; learn "
        "a symmetric family, bab2 to bab6 or aba4 to aba6",
        method.method.name(), word.letters);
  }
  // Half of the list, in pairs; the central letter is halved, as the list is taken there and back.
  const std::size_t half = word.letters.size() / 2;
  std::vector<double> r(word.coefficients.begin(),
                        word.coefficients.begin() + static_cast<std::ptrdiff_t>(half + 1));
  r.back() *= 0.5;
  if (r.size() % 2 == 1) r.push_back(0.0);
  auto values = values_of_header(method, "#");
  values.emplace_back("LIST", digits(r));
  values.emplace_back("FIRST", word.letters.front() == 'B' ? "0" : "1");
  return fill(R"(@HEADER@#
@EXPLAINED@
# A scheme of GPT beside OMF2 and OMF4: the list is taken there and back, updates of momenta and fields in turn.
#   integrator = @NAME@_scheme(N, update_momenta, update_fields)
#   integrator(tau)
# Test, of a stand-in with the loop of gpt.algorithms.integrator.symplectic.schemes.generic: python3 FILE
COEFFICIENTS = [@LIST@]
FIRST = @FIRST@  # 0: an update of momenta is first, 1: one of fields


def @NAME@_scheme(N, i0, i1):
    from gpt.algorithms.integrator.symplectic.schemes import generic
    return generic(N, [i0, i1], COEFFICIENTS, [(FIRST + k) % 2 for k in range(len(COEFFICIENTS))], "@NAME@")


def self_test():
    """By how much ten steps of two oscillators end elsewhere than nysalt's own: below 1e-13 by rounding."""
    q, p, h = [0.3, 0.2], [0.1, -0.25], 0.1
    n = len(COEFFICIENTS)
    for _ in range(10):
        for k in list(range(n)) + list(reversed(range(n))):
            c = COEFFICIENTS[k] * h
            if (FIRST + k) % 2 == 0:
                f = [-q[0] - 2 * q[0] * q[1], -q[1] - q[0] ** 2 + q[1] ** 2]
                p = [p[i] + c * f[i] for i in range(2)]
            else:
                q = [q[0] + c * p[0], q[1] + c * 0.5 * p[1]]
    return max(abs(a - b) for a, b in zip(q + p, [@Q@, @P@]))


@MAIN@)",
              values);
}

}  // namespace nysalt::detail
