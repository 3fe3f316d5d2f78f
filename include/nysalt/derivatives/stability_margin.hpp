// SPDX-License-Identifier: BSL-1.0
// Stability margin: the distance of a step from the ends of the windows of stability.
#pragma once

#include <algorithm>
#include <limits>
#include <vector>

#include "nysalt/derivatives/stability_window.hpp"
#include "nysalt/system.hpp"

namespace nysalt {

/// Stability margin of z = low..high, as a share of the stability interval: 1 - high/end, and where the
/// window has a beginning above 0 also 1 - beginning/low, whichever is less. A step may grow by the factor
/// 1/(1 - margin) before it is unstable. Negative if some z is unstable: then the end is that of the last
/// window which holds z before it; minus infinity if there is none.
inline double stability_margin(const std::vector<stability_window>& windows, double low, double high) {
  double end = 0.0;
  double margin_below = 1.0;
  for (const auto& window : windows) {
    if (!(window.low <= low)) break;
    end = window.high;
    margin_below = window.low > 0.0 ? 1.0 - window.low / low : 1.0;
  }
  if (!(end > 0.0)) return -std::numeric_limits<double>::infinity();
  return std::min(1.0 - high / end, margin_below);
}

/// Steps from low to high.
struct step_range {
  double low;   ///< the least step
  double high;  ///< the largest step; may be infinite
};

/// Every step at which each band lies in a window, from small to large. Without bands all steps.
inline std::vector<step_range> stable_steps(const std::vector<stability_window>& windows,
                                            const std::vector<frequency_band>& bands) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  std::vector<step_range> result{{0.0, infinity}};
  for (const auto& band : bands) {
    if (!(band.high > 0.0)) continue;
    std::vector<step_range> both;
    for (const auto& window : windows) {
      if (band.low == 0.0 && window.low > 0.0) continue;
      const double low = band.low > 0.0 ? window.low / band.low : 0.0;
      const double high = window.high / band.high;
      for (const auto& range : result) {
        const step_range common{std::max(low, range.low), std::min(high, range.high)};
        if (common.low < common.high) both.push_back(common);
      }
    }
    result = both;
  }
  return result;
}

}  // namespace nysalt
