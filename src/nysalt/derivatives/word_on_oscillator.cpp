// SPDX-License-Identifier: BSL-1.0
#include "nysalt/derivatives/word_on_oscillator.hpp"

#include "nysalt/detail/step_on_oscillator.hpp"

namespace nysalt {

bernstein_polynomial half_trace(const run_time_word& word, const std::vector<double>& coefficients,
                                double theta, double low, double high) {
  const auto times_k = [](const bernstein_polynomial& x) { return x.times_x(); };
  const bernstein_polynomial one(low, high, 1.0);
  const bernstein_polynomial zero(low, high, 0.0);
  auto qq = one, pq = zero, qp = zero, pp = one;
  step_on_oscillator(word, coefficients, theta, times_k, qq, pq);
  step_on_oscillator(word, coefficients, theta, times_k, qp, pp);
  return 0.5 * (qq += pp);
}

}  // namespace nysalt
