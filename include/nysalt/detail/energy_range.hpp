// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace nysalt {

/// From the least to the largest H that was seen.
struct energy_range {
  double low = std::numeric_limits<double>::infinity();    ///< the least; above `high` before any
  double high = -std::numeric_limits<double>::infinity();  ///< the largest; below `low` before any

  /// Widens the range where it does not hold an energy.
  void include(double energy) {
    low = std::min(low, energy);
    high = std::max(high, energy);
  }

  /// The distance of an energy from the range; 0 inside, and within a millionth of the largest: where all
  /// trajectories have one energy, that of another differs by rounding and by the reference's error.
  double distance(double energy) const {
    if (!(low <= high)) return std::numeric_limits<double>::infinity();  // nothing was seen
    const double slack = 1e-6 * std::max(std::abs(low), std::abs(high));
    const double outside = std::max(low - energy, energy - high);
    return outside <= slack ? 0.0 : outside;
  }
  bool contains(double energy) const { return distance(energy) == 0.0; }  ///< or off by a millionth
};

}  // namespace nysalt
