// SPDX-License-Identifier: BSL-1.0
#include "nysalt/derivatives/transient_growth.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "nysalt/detail/step_on_oscillator.hpp"

namespace nysalt {

namespace {

/// Of (a, b; c, d): the square of its Frobenius norm and its determinant give both singular values.
double spectral_norm(double a, double b, double c, double d) {
  const double squares = a * a + b * b + c * c + d * d;
  const double twice = 2.0 * std::abs(a * d - b * c);
  return 0.5 * (std::sqrt(squares + twice) + std::sqrt(std::max(0.0, squares - twice)));
}

}  // namespace

double transient_growth(const run_time_word& word, const std::vector<double>& coefficients, double theta,
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
  const double last = spectral_norm(cosine + ratio * a, ratio * b, ratio * c, cosine - ratio * a);
  return last < 1.0 ? 1.0 : last;
}

}  // namespace nysalt
