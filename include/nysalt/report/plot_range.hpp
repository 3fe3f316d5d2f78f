// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "nysalt/report/figure.hpp"
#include "nysalt/report/plot_ticks.hpp"

namespace nysalt::detail {

struct log_range {
  double low = 0.0;
  double high = 0.0;
  int outside = 0;  // points

  bool is_empty() const { return !(low > 0.0); }
};

/// Of y on a logarithmic axis: all points within Tukey's outer fences of log10 y, three interquartile ranges
/// from the quartiles and at least three decades, as an error of 1e30 would leave the others a line. Levels
/// are always within, and points up to ten times the highest: there is where an error is compared.
inline log_range range_of_logarithms(const panel& its) {
  std::vector<double> values;
  for (const auto& curve : its.curves) {
    for (std::size_t i = 0; i < curve.y.size(); ++i) {
      if (std::isfinite(curve.x[i]) && std::isfinite(curve.y[i]) && curve.y[i] > 0.0) {
        values.push_back(std::log10(curve.y[i]));
      }
    }
  }
  std::vector<double> levels;
  for (const auto& level : its.levels) {
    if (std::isfinite(level.y) && level.y > 0.0) levels.push_back(std::log10(level.y));
  }
  std::vector<double> shown = levels;
  int outside = 0;
  if (!values.empty()) {
    std::sort(values.begin(), values.end());
    const double lower = values[values.size() / 4];
    const double upper = values[(3 * values.size()) / 4];
    const double reach = std::max(3.0, 3.0 * (upper - lower));
    double fence = upper + reach;
    for (const double level : levels) fence = std::max(fence, level + 1.0);
    for (const double value : values) {
      const bool inside = value >= lower - reach && value <= fence;
      if (inside) shown.push_back(value);
      if (!inside) ++outside;
    }
  }
  if (shown.empty()) return {};
  const auto [low, high] = std::minmax_element(shown.begin(), shown.end());
  const double margin = std::max(std::log10(2.0), 0.05 * (*high - *low));  // a level's name has room
  return {std::pow(10.0, *low - margin), std::pow(10.0, *high + margin), outside};
}

/// Of x on a logarithmic axis, with a margin; empty where there is no positive point.
inline log_range range_of_costs(const panel& its) {
  double low = std::numeric_limits<double>::infinity();
  double high = 0.0;
  for (const auto& curve : its.curves) {
    for (std::size_t i = 0; i < curve.x.size(); ++i) {
      if (!std::isfinite(curve.x[i]) || !std::isfinite(curve.y[i]) || !(curve.x[i] > 0.0)) continue;
      low = std::min(low, curve.x[i]);
      high = std::max(high, curve.x[i]);
    }
  }
  if (!(high > 0.0)) return {};
  const axis_range wide = at_least_threefold({low, high});
  const double margin = std::pow(wide.high / wide.low, 0.05);  // a twentieth of the axis
  return {wide.low / margin, wide.high * margin};
}

}  // namespace nysalt::detail
