// SPDX-License-Identifier: BSL-1.0
// Derivatives of what cannot be differentiated otherwise.
#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <limits>

namespace nysalt::detail {

/// With steps s = cbrt(eps) a function that changes over lengths L gives s^2/(6 L^2), and one that is r times
/// its derivative gives r eps/s: both are below this for L > 2e-4 and r < 5e6.
inline double tolerance_of_differences() { return 30.0 * std::cbrt(std::numeric_limits<double>::epsilon()); }

/// The derivative of function(vector), a double or a vector, along a direction: of a step in which the
/// coordinate that goes farthest for its size goes cbrt(eps) of max(1, |x_i|).
auto difference_along(const auto& function, const Eigen::VectorXd& x, const Eigen::VectorXd& direction) {
  double farthest = 0.0;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    farthest = std::max(farthest, std::abs(direction[i]) / std::max(1.0, std::abs(x[i])));
  }
  const double s = std::cbrt(std::numeric_limits<double>::epsilon()) / farthest;
  const Eigen::VectorXd ahead = x + s * direction;
  const Eigen::VectorXd behind = x - s * direction;
  auto result = function(ahead);
  result -= function(behind);
  result /= 2.0 * s;
  return result;
}

}  // namespace nysalt::detail
