// SPDX-License-Identifier: BSL-1.0
#include "plot_range.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "plot_ticks.hpp"

namespace nysalt::detail {

log_range range_of_logarithms(const panel& plot) {
  std::vector<double> values;
  for (const auto& curve : plot.curves) {
    for (std::size_t i = 0; i < curve.y.size(); ++i) {
      if (std::isfinite(curve.x[i]) && std::isfinite(curve.y[i]) && curve.y[i] > 0.0) {
        values.push_back(std::log10(curve.y[i]));
      }
    }
  }
  std::vector<double> levels;
  for (const auto& level : plot.levels) {
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

log_range range_of_costs(const panel& plot) {
  double low = std::numeric_limits<double>::infinity();
  double high = 0.0;
  for (const auto& curve : plot.curves) {
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
