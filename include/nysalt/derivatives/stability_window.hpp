// SPDX-License-Identifier: BSL-1.0
// Steps at which a method is stable.
#pragma once

#include <algorithm>
#include <vector>

namespace nysalt {

/// Stable for low <= z <= high, but for a single point where the matrix is a Jordan block.
struct stability_window {
  double low;
  double high;
};

/// Whether all z in low..high lie in one window.
inline bool is_stable(const std::vector<stability_window>& windows, double low, double high) {
  return std::any_of(windows.begin(), windows.end(),
                     [&](const auto& window) { return window.low <= low && high <= window.high; });
}

}  // namespace nysalt
