// SPDX-License-Identifier: BSL-1.0
// theta as families have it, and as a search has it.
#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cstddef>

namespace nysalt::test {

template <std::size_t N>
std::array<double, N> array_of(const Eigen::VectorXd& theta) {
  std::array<double, N> result;
  std::ranges::copy(theta, result.begin());
  return result;
}
template <std::size_t N>
Eigen::VectorXd column_of(const std::array<double, N>& theta) {
  return Eigen::Map<const Eigen::VectorXd>(theta.data(), static_cast<Eigen::Index>(N));
}

}  // namespace nysalt::test
