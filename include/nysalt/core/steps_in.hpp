// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace nysalt::detail {

/// By how much horizon/step may err: the horizon, the step, their quotient and a product that made the
/// horizon are rounded by eps/2 each; and steps of a few digits are typed to 1e-9 of one.
inline double rounding_of_steps(double ratio) {
  constexpr double typed = 1e-9;
  return std::max(typed, 2.0 * std::numeric_limits<double>::epsilon() * ratio);
}

/// floor(horizon/step), N for a horizon that is N steps up to rounding.
inline double steps_in(double horizon, double step) {
  const double ratio = horizon / step;
  return std::floor(ratio + rounding_of_steps(ratio));
}

}  // namespace nysalt::detail
