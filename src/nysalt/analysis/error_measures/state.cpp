// SPDX-License-Identifier: BSL-1.0
#include "nysalt/analysis/error_measures/state.hpp"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <span>
#include <stdexcept>
#include <vector>

#include "nysalt/detail/sentence.hpp"

namespace nysalt {

namespace {

/// Entries of a matrix that are not zero, row by row: modes often touch but a few masses.
struct matrix_entry {
  std::size_t row;
  Eigen::Index column;
  double value;
};

std::vector<matrix_entry> entries_of(const Eigen::MatrixXd& a) {
  std::vector<matrix_entry> result;
  for (Eigen::Index i = 0; i < a.rows(); ++i) {
    for (Eigen::Index j = 0; j < a.cols(); ++j) {
      if (a(i, j) != 0.0) result.push_back({static_cast<std::size_t>(i), j, a(i, j)});
    }
  }
  return result;
}

/// The maps from q to w_k x_k and from p to y_k.
struct weighted_modes {
  std::vector<matrix_entry> to_x;
  std::vector<matrix_entry> to_y;
};

weighted_modes modes_with_weights(const model& system) {
  const Eigen::Index n = system.size();
  Eigen::VectorXd root_mass(n);
  for (Eigen::Index i = 0; i < n; ++i) root_mass[i] = system.root_mass(i);
  weighted_modes result;
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
  for (Eigen::Index i = 0; i < n; ++i) {  // not as a matrix, which a long chain has no room for
    result.to_x.push_back({static_cast<std::size_t>(i), i, root_mass[i]});
    result.to_y.push_back({static_cast<std::size_t>(i), i, 1.0 / root_mass[i]});
  }
  return result;
}

}  // namespace

error_measure state_measure(const model& system) {
  const auto n = static_cast<std::size_t>(system.size());
  const auto modes = std::make_shared<const weighted_modes>(modes_with_weights(system));
  const auto read = [n, modes]<class T>(const phase_point<T, Eigen::Dynamic>& x, std::span<T> result) {
    std::fill(result.begin(), result.end(), T(0.0));
    for (const auto& [k, i, value] : modes->to_x) result[k] += x.q[i] * value;
    for (const auto& [k, i, value] : modes->to_y) result[n + k] += x.p[i] * value;
  };
  const auto error = []<class T>(std::span<const T> seen, std::span<const T> expected) {
    T sum(0.0);
    for (std::size_t k = 0; k < seen.size(); ++k) {
      sum += (seen[k] - expected[k]) * (seen[k] - expected[k]);
    }
    return sum;
  };
  return {.name = "state",
          .width = 2 * n,
          .read = read,
          .error = error,
          .how = averaging::root_of_all,
          .dimension = system.size()};
}

}  // namespace nysalt
