// SPDX-License-Identifier: BSL-1.0
// Slopes and thresholds of curves of errors against steps.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "nysalt/analysis/statistics.hpp"

namespace nysalt::program::paper {

/// Of the least-squares line through (x, y); the standard error is that of the residuals.
inline estimate fitted_slope(std::span<const double> x, std::span<const double> y) {
  const auto n = static_cast<double>(x.size());
  if (x.size() < 2) return {};
  const double b = slope(x, y);
  const double mean_x = mean_and_error(x).mean;
  const double mean_y = mean_and_error(y).mean;
  double residuals = 0.0;
  double spread = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double r = y[i] - mean_y - b * (x[i] - mean_x);
    residuals += r * r;
    spread += (x[i] - mean_x) * (x[i] - mean_x);
  }
  if (x.size() < 3) return {b, std::numeric_limits<double>::quiet_NaN()};
  return {b, std::sqrt(residuals / (n - 2.0) / spread)};
}

inline std::vector<double> logs(std::span<const double> x) {
  std::vector<double> result;
  for (const double value : x) result.push_back(std::log(value));
  return result;
}

/// Exponent of y ~ x^exponent.
inline estimate exponent(std::span<const double> x, std::span<const double> y) {
  return fitted_slope(logs(x), logs(y));
}

/// A curve of errors: NaN or infinity where nothing was left of the trajectories.
struct error_curve {
  std::vector<double> at;
  std::vector<estimate> errors;

  std::vector<double> means() const {
    std::vector<double> result;
    for (const auto& e : errors) result.push_back(e.mean);
    return result;
  }
  std::vector<double> bars() const {
    std::vector<double> result;
    for (const auto& e : errors) result.push_back(e.standard_error);
    return result;
  }
  /// Exponent over the points from `low` to `high`.
  estimate exponent_within(double low, double high) const {
    std::vector<double> x;
    std::vector<double> y;
    for (std::size_t i = 0; i < at.size(); ++i) {
      const bool counts = at[i] >= low && at[i] <= high && std::isfinite(errors[i].mean);
      if (!counts) continue;
      x.push_back(at[i]);
      y.push_back(errors[i].mean);
    }
    return exponent(x, y);
  }
};

/// Where the curve first rises above a threshold, by a line through logarithms; its standard error is that of
/// the two points over the slope. The last point where it never does, the first where it always is above.
inline estimate crossing(const error_curve& curve, double threshold) {
  const auto is_above = [&](std::size_t i) { return !(curve.errors[i].mean <= threshold); };
  for (std::size_t i = 0; i < curve.at.size(); ++i) {
    if (!is_above(i)) continue;
    if (i == 0) return {curve.at.front(), 0.0};
    const double x0 = std::log(curve.at[i - 1]);
    const double x1 = std::log(curve.at[i]);
    const estimate& low = curve.errors[i - 1];
    const estimate& high = curve.errors[i];
    if (!std::isfinite(high.mean)) return {curve.at[i - 1], 0.5 * (curve.at[i] - curve.at[i - 1])};
    const double rise = std::log(high.mean / low.mean);
    const double part = std::log(threshold / low.mean) / rise;
    const double relative =
        std::hypot((1.0 - part) * low.standard_error / low.mean, part * high.standard_error / high.mean);
    const double place = std::exp(x0 + part * (x1 - x0));
    return {place, place * relative * (x1 - x0) / rise};
  }
  return {curve.at.back(), 0.0};
}

/// Whether a threshold that the paper gives as a gap of its grid is ours: within one distance of that grid
/// and two standard errors.
inline bool is_gap(const estimate& ours, double printed, double distance) {
  return std::abs(ours.mean - printed) <= distance + 2.0 * ours.standard_error;
}

}  // namespace nysalt::program::paper
