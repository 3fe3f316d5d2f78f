// SPDX-License-Identifier: BSL-1.0
// How much a word with rotations magnifies an oscillation: what resonances do, and how soon.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <vector>

#include "nysalt/derivatives/word_on_oscillator.hpp"

namespace nysalt {

namespace detail {
/// Of (a, b; c, d): the square of its Frobenius norm and its determinant give both singular values.
inline double spectral_norm(double a, double b, double c, double d) {
  const double squares = a * a + b * b + c * c + d * d;
  const double twice = 2.0 * std::abs(a * d - b * c);
  return 0.5 * (std::sqrt(squares + twice) + std::sqrt(std::max(0.0, squares - twice)));
}
}  // namespace detail

/// Largest |M^n| of n = 1 .. steps steps on q'' = -(theta^2 + k) q, k > 0, in the norm of its energy, which
/// the motion itself conserves; see step_on_oscillator(). Stable or not is too coarse a question where words
/// rotate: at h omega = j pi the impulse method has the trace 2 (-1)^j for every soft force, and grows
/// without a bound, but slowly; others are stable there but for a width or a rate that is nil. With trace/2 =
/// +-cos t, t <= pi/2, +-M^n = cos(n t) + (+-M - cos t) sin(n t)/sin t, taken at n t = pi/2 or the last step,
/// whichever is first; cosh and sinh where it is unstable. NaN where a coefficient is. Cost: a step.
inline double magnification(const run_time_word& word, const std::vector<double>& coefficients, double theta,
                            double k, std::int64_t steps) {
  const auto times_k = [k](double x) { return k * x; };
  double qq = 1.0, pq = 0.0, qp = 0.0, pp = 1.0;
  step_on_oscillator(word, coefficients, theta, times_k, qq, pq);
  step_on_oscillator(word, coefficients, theta, times_k, qp, pp);

  // M - trace/2 = (a, b; c, -a) in (omega q, p); its determinant is sin^2 t.
  const double omega = std::sqrt(theta * theta + k);
  const double sign = qq + pp < 0.0 ? -1.0 : 1.0;
  const double a = sign * 0.5 * (qq - pp);
  const double b = sign * omega * qp;
  const double c = sign * pq / omega;
  const double square = -a * a - b * c;
  const double sine = std::sqrt(std::abs(square));

  const auto n = static_cast<double>(steps);
  double cosine = 1.0;  // of n t
  double ratio = n;     // sin(n t)/sin t
  if (sine > std::numeric_limits<double>::min() && square > 0.0) {
    const double angle = std::min(n * std::asin(std::min(sine, 1.0)), 0.5 * std::numbers::pi);
    cosine = std::cos(angle);
    ratio = std::sin(angle) / sine;
  } else if (sine > std::numeric_limits<double>::min()) {
    const double angle = n * std::asinh(sine);
    cosine = std::cosh(angle);
    ratio = std::sinh(angle) / sine;
  }
  const double last = detail::spectral_norm(cosine + ratio * a, ratio * b, ratio * c, cosine - ratio * a);
  return last < 1.0 ? 1.0 : last;
}

}  // namespace nysalt
