// SPDX-License-Identifier: BSL-1.0
// Sample moments, and how far they may be off: thresholds of statistical tests follow from the rate of false
// alarms that a test states.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace nysalt::test {

/// The probability with which a stochastic test case fails although all is right, at a random seed: two
/// hundred cases together fail in fewer than one of 1000 runs. A case of N comparisons has 1/N of it for each
/// (Bonferroni). tests/stochastic.md lists the cases.
constexpr double false_alarms = 5e-6;

/// The number of standard errors by which a right mean is off, to either side, with that probability; of
/// Student's distribution where the standard error was estimated, with that many degrees of freedom.
/// Compiled once, as is most_of(): the quantiles take seconds to compile.
double standard_errors(double probability, double degrees = std::numeric_limits<double>::infinity());

/// What kolmogorov_smirnov() exceeds with that probability, 2 exp(-2 x^2), or less.
inline double kolmogorov_smirnov_limit(double probability) {
  return std::sqrt(0.5 * std::log(2.0 / probability));
}

/// The number of n independent events of probability p that is exceeded with that probability, or less.
int most_of(int n, double p, double probability);

inline double mean(const std::vector<double>& x) {
  double sum = 0.0;
  for (const double value : x) sum += value;
  return sum / static_cast<double>(x.size());
}

inline double covariance(const std::vector<double>& x, const std::vector<double>& y) {
  const double mx = mean(x);
  const double my = mean(y);
  double sum = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) sum += (x[i] - mx) * (y[i] - my);
  return sum / static_cast<double>(x.size() - 1);
}

inline double correlation(const std::vector<double>& x, const std::vector<double>& y) {
  return covariance(x, y) / std::sqrt(covariance(x, x) * covariance(y, y));
}

/// Mean and deviation of normal numbers and the correlation of independent ones, in standard errors:
/// sd/sqrt(n), sd/sqrt(2 n) and 1/sqrt(n).
inline double mean_off(const std::vector<double>& x, double expected, double sd) {
  return std::abs(mean(x) - expected) / sd * std::sqrt(static_cast<double>(x.size()));
}
inline double deviation_off(const std::vector<double>& x, double sd) {
  return std::abs(std::sqrt(covariance(x, x)) / sd - 1.0) * std::sqrt(2.0 * static_cast<double>(x.size()));
}
inline double correlation_off(const std::vector<double>& x, const std::vector<double>& y) {
  return std::abs(correlation(x, y)) * std::sqrt(static_cast<double>(x.size()));
}

/// The standard normal distribution.
inline double normal_law(double x) { return 0.5 * std::erfc(-x / std::sqrt(2.0)); }

/// Kolmogorov and Smirnov's sqrt(n) sup |F_n - F| for the standard normal distribution.
inline double kolmogorov_smirnov(std::vector<double> x) {
  std::sort(x.begin(), x.end());
  const auto n = static_cast<double>(x.size());
  double worst = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double law = normal_law(x[i]);
    worst = std::max(
        {worst, std::abs(law - static_cast<double>(i) / n), std::abs(law - static_cast<double>(i + 1) / n)});
  }
  return worst * std::sqrt(n);
}

}  // namespace nysalt::test
