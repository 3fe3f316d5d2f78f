// SPDX-License-Identifier: BSL-1.0
// A step of a word on the harmonic oscillator, as a matrix.
#pragma once

#include <vector>

#include "nysalt/detail/step_on_oscillator.hpp"

namespace nysalt::test {

/// (q, p) to (q, p), p in units of q/h.
struct step_matrix {
  double qq = 1.0;
  double qp = 0.0;
  double pq = 0.0;
  double pp = 1.0;
  double half_trace() const { return 0.5 * (qq + pp); }
};

/// Of q'' = -x q with a step of size 1, all of which kicks know.
inline step_matrix matrix_on_oscillator(const run_time_word& word, const std::vector<double>& coefficients,
                                        double x) {
  const auto times_x = [x](double q) { return x * q; };
  step_matrix m;
  step_on_oscillator(word, coefficients, 0.0, times_x, m.qq, m.pq);
  step_on_oscillator(word, coefficients, 0.0, times_x, m.qp, m.pp);
  return m;
}

}  // namespace nysalt::test
