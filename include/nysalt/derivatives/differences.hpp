// SPDX-License-Identifier: BSL-1.0
// Derivatives of what cannot be differentiated otherwise.
#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>
#include <vector>

#include "nysalt/force.hpp"

namespace nysalt::detail {

/// Adapted differences err by 1e-7 of what they differentiate for one that is some r = |V|/(L |f|) = 1 of it,
/// and by r times their rounding, 1e-11: below this for r < 10^7.
inline double tolerance_of_differences() { return 30.0 * std::cbrt(std::numeric_limits<double>::epsilon()); }

/// The derivative of function(vector), a double or a vector, along a direction whose size is that of a
/// displacement of the motion.
auto difference_along(const auto& function, const Eigen::VectorXd& x, const Eigen::VectorXd& direction) {
  using result_type = std::decay_t<decltype(function(x))>;
  const double farthest = farthest_from(x, direction);
  if constexpr (std::is_same_v<result_type, double>) {
    using number = Eigen::Matrix<double, 1, 1>;
    const auto value_at = [&](double s, number& y) { y[0] = function(Eigen::VectorXd(x + s * direction)); };
    const number middle(function(x));
    number result(0.0);
    adapted_difference(value_at, middle, number(1.0), noise_of_forces * std::abs(middle[0]), farthest,
                       result);
    return result[0];
  } else {
    const auto value_at = [&](double s, Eigen::VectorXd& y) {
      y = function(Eigen::VectorXd(x + s * direction));
    };
    const Eigen::VectorXd middle = function(x);
    const double noise = noise_of_forces * direction.cwiseAbs().dot(middle.cwiseAbs());
    Eigen::VectorXd result = x;
    adapted_difference(value_at, middle, direction, noise, farthest, result);
    return result;
  }
}

/// The length of each coordinate, from where points are: the distance between the lowest and the highest. Of
/// a coordinate that does not move that of the one that moves farthest; if none does how far all are from the
/// origin, and 1 if they are there.
inline Eigen::VectorXd lengths_of(const std::vector<Eigen::VectorXd>& points) {
  Eigen::VectorXd low = points.front();
  Eigen::VectorXd high = points.front();
  for (const auto& x : points) {
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  const Eigen::VectorXd size = low.cwiseAbs().cwiseMax(high.cwiseAbs());
  constexpr double rounding = 1e-9;  // of where a coordinate is: less cannot be divided into steps
  Eigen::VectorXd result = high - low;
  for (Eigen::Index i = 0; i < result.size(); ++i) {
    if (!(result[i] > rounding * size[i])) result[i] = 0.0;
  }
  double instead = result.maxCoeff();
  if (!(instead > 0.0)) instead = size.maxCoeff();
  if (!(instead > 0.0) || !std::isfinite(instead)) instead = 1.0;
  for (double& length : result) {
    if (!(length > 0.0) || !std::isfinite(length)) length = instead;
  }
  return result;
}

}  // namespace nysalt::detail
