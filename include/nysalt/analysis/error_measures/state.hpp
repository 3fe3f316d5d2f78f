// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <stdexcept>
#include <vector>

#include "nysalt/analysis/error_measure.hpp"
#include "nysalt/detail/sentence.hpp"
#include "nysalt/system.hpp"

namespace nysalt {

namespace detail {

/// Entries of a matrix that are not zero, row by row: modes often touch but a few masses.
struct matrix_entry {
  std::size_t row;
  Eigen::Index column;
  double value;
};
std::vector<matrix_entry> entries_of(const Eigen::MatrixXd& a);

/// The maps from q to w_k x_k and from p to y_k.
struct weighted_modes {
  std::vector<matrix_entry> to_x;
  std::vector<matrix_entry> to_y;
};

/// Throws std::invalid_argument if the system's modes are not as many as its degrees of freedom.
template <System S>
weighted_modes modes_with_weights(const S& system) {
  const Eigen::Index n = size(system);
  Eigen::VectorXd root_mass = Eigen::VectorXd::Ones(n);
  if constexpr (HasInverseMass<S>) {
    for (Eigen::Index i = 0; i < n; ++i) root_mass[i] = 1.0 / std::sqrt(system.inverse_mass(i));
  }
  weighted_modes result;
  if constexpr (HasModes<S>) {
    if (has_modes(system)) {
      const normal_modes modes = system.modes();
      if (modes.basis.rows() != n || modes.basis.cols() != n || modes.frequencies.size() != n) {
        throw std::invalid_argument(
            sentence("the state error needs {} modes of {}, each with a frequency", n, describe(system)));
      }
      const Eigen::VectorXd weights = (modes.frequencies.array() == 0.0).select(1.0, modes.frequencies);
      result.to_x = entries_of(weights.asDiagonal() * modes.basis.transpose() * root_mass.asDiagonal());
      result.to_y = entries_of(modes.basis.transpose() * root_mass.cwiseInverse().asDiagonal());
      return result;
    }
  }
  for (Eigen::Index i = 0; i < n; ++i) {  // not as a matrix, which a long chain has no room for
    result.to_x.push_back({static_cast<std::size_t>(i), i, root_mass[i]});
    result.to_y.push_back({static_cast<std::size_t>(i), i, 1.0 / root_mass[i]});
  }
  return result;
}

}  // namespace detail

/// The error of the state in the energy norm, e^2 = sum_k w_k^2 dx_k^2 + dy_k^2 in the system's modes
/// x = U^T M^{1/2} q, y = U^T M^{-1/2} p: sqrt(mean over trajectories and times of e^2), absolute. A mode of
/// frequency zero has weight 1; a system without modes() is measured in mass-weighted coordinates, all
/// weights 1. Throws std::invalid_argument if modes() has not the system's size. Cost of a sample: a product
/// with each entry of 2 N modes that is not zero.
template <System S>
error_measure<S::dimension, lanes_of<S>> state_measure(const S& system) {
  using T = scalar_of_lanes<lanes_of<S>>;
  using numbers = std::span<const T>;
  const auto n = static_cast<std::size_t>(size(system));
  const auto read = [n, modes = detail::modes_with_weights(system)](const auto& x, std::span<T> result) {
    std::fill(result.begin(), result.end(), T(0.0));
    for (const auto& [k, i, value] : modes.to_x) result[k] += x.q[i] * value;
    for (const auto& [k, i, value] : modes.to_y) result[n + k] += x.p[i] * value;
  };
  const auto error = [](numbers seen, numbers expected) {
    T sum(0.0);
    for (std::size_t k = 0; k < seen.size(); ++k) {
      sum += (seen[k] - expected[k]) * (seen[k] - expected[k]);
    }
    return sum;
  };
  return {"state", 2 * n, read, error, averaging::root_of_all};
}

}  // namespace nysalt
