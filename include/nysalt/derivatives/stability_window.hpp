// SPDX-License-Identifier: BSL-1.0
// Values of z = h omega at which a method is stable.
#pragma once

#include <algorithm>
#include <vector>

namespace nysalt {

/// Stable for low <= z <= high, but for a single point where the matrix is a Jordan block.
struct stability_window {
  double low;   ///< the least z = h omega
  double high;  ///< the largest z = h omega
};

/// All windows, from small z to large, and the z within them where two touch.
struct stability_chart {
  std::vector<stability_window> windows;  ///< disjoint, in order
  /// There the matrix is +-I: an oscillator is back after a step or two, and the errors that a nonlinear
  /// system makes at each add up.
  std::vector<double> touching;
};

/// Whether all z in low..high lie in one window.
inline bool is_stable(const std::vector<stability_window>& windows, double low, double high) {
  return std::any_of(windows.begin(), windows.end(),
                     [&](const auto& window) { return window.low <= low && high <= window.high; });
}

/// The parts of 0..highest that lie in no window.
inline std::vector<stability_window> gaps_below(const std::vector<stability_window>& windows,
                                                double highest) {
  std::vector<stability_window> gaps;
  double last = 0.0;
  for (const auto& window : windows) {
    const double next = std::min(window.low, highest);
    if (last < next) gaps.push_back({last, next});
    last = window.high;
  }
  if (last < highest) gaps.push_back({last, highest});
  return gaps;
}

}  // namespace nysalt
