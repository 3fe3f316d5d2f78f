// SPDX-License-Identifier: BSL-1.0
#include "nysalt/derivatives/sum_resonance.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

#include "nysalt/detail/step_on_oscillator.hpp"

namespace nysalt {

double growth_of_pair(const run_time_word& word, const std::vector<double>& coefficients,
                      const Eigen::Array2d& theta, const Eigen::Matrix2d& k) {
  const auto times_k = [&](const Eigen::Array2d& x) -> Eigen::Array2d { return (k * x.matrix()).array(); };
  Eigen::Matrix4d step;
  for (Eigen::Index j = 0; j < 4; ++j) {
    Eigen::Array2d q = Eigen::Array2d::Zero();
    Eigen::Array2d p = Eigen::Array2d::Zero();
    (j < 2 ? q : p)[j % 2] = 1.0;
    step_on_oscillator(word, coefficients, theta, times_k, q, p);
    step.col(j) << q, p;
  }
  if (!step.allFinite()) return std::numeric_limits<double>::infinity();
  const double a = step.trace();
  const double b = 0.5 * (a * a - (step * step).trace());
  const std::complex<double> root = std::sqrt(std::complex<double>(0.25 * a * a - b + 2.0));
  double growth = 0.0;
  for (const double sign : {1.0, -1.0}) {
    const std::complex<double> half = 0.5 * (0.5 * a + sign * root);  // of y
    const std::complex<double> lambda = half + std::sqrt(half * half - 1.0);
    growth = std::max(growth, std::abs(std::log(std::abs(lambda))));
  }
  return growth;
}

}  // namespace nysalt
