// SPDX-License-Identifier: BSL-1.0

#include "jackknife.hpp"

#include <algorithm>
#include <limits>

namespace nysalt::detail {

double jackknife_variance(std::span<const double> without, double all) {
  if (without.size() < 2) return std::numeric_limits<double>::quiet_NaN();
  const auto groups = static_cast<double>(without.size());
  double sum = 0.0;
  double squares = 0.0;
  for (const double value : without) {
    const double change = value - all;
    sum += change;
    squares += change * change;
  }
  return std::max(squares - sum * sum / groups, 0.0) * ((groups - 1.0) / groups);
}

}  // namespace nysalt::detail
