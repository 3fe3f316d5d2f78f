// SPDX-License-Identifier: BSL-1.0
// How much a word with rotations magnifies an oscillation: what resonances do, and how soon.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "nysalt/derivatives/word_on_oscillator.hpp"

namespace nysalt {

/// Largest |M^n| of n = 1 .. steps steps on q'' = -(theta^2 + k) q, k > 0, in the norm of its energy, which
/// the motion itself conserves; see step_on_oscillator(). Stable or not is too coarse a question here: at h
/// omega = j pi the impulse method has the trace 2 (-1)^j for every soft force, and grows without a bound,
/// but slowly; others are stable there but for a width or a rate that is nil. NaN where a coefficient is.
/// With trace/2 = cos t, M^n = cos(n t) + (M - cos t) sin(n t)/sin t, and det(M - cos t) = sin^2 t. Cost: a
/// step.
inline double magnification(const run_time_word& word, const std::vector<double>& coefficients, double theta,
                            double k, std::int64_t steps) {
  const auto times_k = [k](double x) { return k * x; };
  double qq = 1.0, pq = 0.0, qp = 0.0, pp = 1.0;
  step_on_oscillator(word, coefficients, theta, times_k, qq, pq);
  step_on_oscillator(word, coefficients, theta, times_k, qp, pp);

  // M - trace/2 = (a, b; c, -a) in (omega q, p), and its norm.
  const double omega = std::sqrt(theta * theta + k);
  const double a = 0.5 * (qq - pp);
  const double b = omega * qp;
  const double c = pq / omega;
  const double determinant = -a * a - b * c;
  const double squares = 2.0 * a * a + b * b + c * c;
  const double norm = 0.5 * (std::sqrt(squares + 2.0 * std::abs(determinant)) +
                             std::sqrt(std::max(0.0, squares - 2.0 * std::abs(determinant))));
  const auto n = static_cast<double>(steps);
  const double sine = std::sqrt(std::abs(determinant));
  double longest = n;  // of sin(n t)/sin t
  if (sine > std::numeric_limits<double>::min()) {
    const double angle = determinant > 0.0 ? std::asin(std::min(sine, 1.0)) : std::asinh(sine);
    if (determinant > 0.0) longest = (n * angle < 1.5 ? std::sin(n * angle) : 1.0) / sine;
    if (determinant < 0.0) longest = std::sinh(n * angle) / sine;
  }
  const double largest = longest * norm;
  return largest < 1.0 ? 1.0 : largest;
}

}  // namespace nysalt
