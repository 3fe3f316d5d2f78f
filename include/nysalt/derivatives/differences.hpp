// SPDX-License-Identifier: BSL-1.0
// Derivatives of what cannot be differentiated otherwise.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "nysalt/phase_point.hpp"

namespace nysalt::detail {

/// With steps s = cbrt(eps) a function that changes over lengths L gives s^2/(6 L^2), and one that is r times
/// its derivative gives r eps/s: both are below this for L > 2e-4 and r < 5e6.
inline double tolerance_of_differences() { return 30.0 * std::cbrt(std::numeric_limits<double>::epsilon()); }

/// result = the derivative along coordinate j of function(vector), which returns a double or a vector.
template <int N>
auto central_difference(const auto& function, const vector<double, N>& x, Eigen::Index j) {
  const double s = std::cbrt(std::numeric_limits<double>::epsilon()) * std::max(1.0, std::abs(x[j]));
  auto ahead = x;
  auto behind = x;
  ahead[j] += s;
  behind[j] -= s;
  const double apart = ahead[j] - behind[j];
  auto result = function(ahead);
  result -= function(behind);
  result /= apart;
  return result;
}

/// The Jacobian of function(x), which returns a vector: column j is its derivative along coordinate j.
template <int N>
Eigen::MatrixXd difference_jacobian(const auto& function, const vector<double, N>& x) {
  Eigen::MatrixXd result(x.size(), x.size());
  for (Eigen::Index j = 0; j < x.size(); ++j) result.col(j) = central_difference<N>(function, x, j);
  return result;
}

}  // namespace nysalt::detail
