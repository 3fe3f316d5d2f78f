// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

namespace nysalt {

/// A mean over independent trajectories and its standard error. NaN where there are too few.
struct estimate {
  double mean = std::numeric_limits<double>::quiet_NaN();
  double standard_error = std::numeric_limits<double>::quiet_NaN();
};

inline estimate mean_and_error(std::span<const double> samples) {
  const auto n = static_cast<double>(samples.size());
  if (samples.empty()) return {};
  double mean = 0.0;
  for (const double x : samples) mean += x / n;
  if (samples.size() < 2) return {mean, std::numeric_limits<double>::quiet_NaN()};
  double variance = 0.0;
  for (const double x : samples) variance += (x - mean) * (x - mean) / (n - 1.0);
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
