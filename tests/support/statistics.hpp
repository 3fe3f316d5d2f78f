// SPDX-License-Identifier: BSL-1.0
// Sample moments, and how far they may be off: thresholds of statistical tests are 4 standard errors, which
// a right program passes at a fixed seed with a probability of 0.99994.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace nysalt::test {

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

/// Mean and deviation of normal numbers, in standard errors: sd/sqrt(n) and sd/sqrt(2 n).
inline double mean_off(const std::vector<double>& x, double expected, double sd) {
  return std::abs(mean(x) - expected) / sd * std::sqrt(static_cast<double>(x.size()));
}
inline double deviation_off(const std::vector<double>& x, double sd) {
  return std::abs(std::sqrt(covariance(x, x)) / sd - 1.0) * std::sqrt(2.0 * static_cast<double>(x.size()));
}

/// Kolmogorov and Smirnov's sqrt(n) sup |F_n - F| for the standard normal law; beyond 2.0 with a
/// probability of 2 exp(-8) = 0.0007.
inline double kolmogorov_smirnov(std::vector<double> x) {
  std::sort(x.begin(), x.end());
  const auto n = static_cast<double>(x.size());
  double worst = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double law = 0.5 * std::erfc(-x[i] / std::sqrt(2.0));
    worst = std::max(
        {worst, std::abs(law - static_cast<double>(i) / n), std::abs(law - static_cast<double>(i + 1) / n)});
  }
  return worst * std::sqrt(n);
}

}  // namespace nysalt::test
