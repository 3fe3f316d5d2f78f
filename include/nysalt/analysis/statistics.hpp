// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "nysalt/tree_sum.hpp"

namespace nysalt {

/// A mean over independent trajectories and its standard error. NaN where there are too few.
struct estimate {
  double mean = std::numeric_limits<double>::quiet_NaN();
  double standard_error = std::numeric_limits<double>::quiet_NaN();
};

/// One sample a trajectory, added up by tree_sum; NaN marks a trajectory that does not count.
inline estimate mean_and_error(std::span<const double> samples) {
  double n = 0.0;
  for (const double x : samples) n += std::isnan(x) ? 0.0 : 1.0;
  if (n == 0.0) return {};
  const auto mean_of = [&](const auto& term, double divisor) {
    std::vector<double> terms;
    for (const double x : samples) terms.push_back(std::isnan(x) ? 0.0 : term(x));
    return tree_sum(terms) / divisor;
  };
  const double mean = mean_of([](double x) { return x; }, n);
  if (n < 2.0) return {mean, std::numeric_limits<double>::quiet_NaN()};
  const double variance = mean_of([&](double x) { return (x - mean) * (x - mean); }, n - 1.0);
  return {mean, std::sqrt(variance / n)};
}

/// The middle sample, or the mean of the two in the middle. NaN if there is none.
inline double median(std::vector<double> samples) {
  if (samples.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::sort(samples.begin(), samples.end());
  const std::size_t half = samples.size() / 2;
  return samples.size() % 2 == 1 ? samples[half] : 0.5 * (samples[half - 1] + samples[half]);
}

/// Slope of the least-squares line through (x_i, y_i).
inline double slope(std::span<const double> x, std::span<const double> y) {
  const double mean_x = mean_and_error(x).mean;
  const double mean_y = mean_and_error(y).mean;
  double xy = 0.0;
  double xx = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xy += (x[i] - mean_x) * (y[i] - mean_y);
    xx += (x[i] - mean_x) * (x[i] - mean_x);
  }
  return xy / xx;
}

}  // namespace nysalt
