// SPDX-License-Identifier: BSL-1.0
// The quadratic part of a Hamiltonian by its modes, laid out for rotations.
#pragma once

#include <cmath>
#include <memory>
#include <stdexcept>
#include <vector>

#include "nysalt/detail/sentence.hpp"
#include "nysalt/system.hpp"

namespace nysalt {

/// H_0 = p M^-1 p/2 + q K q/2 with K = M^{1/2} U diag(omega^2) U^T M^{1/2}. In x = U^T M^{1/2} q and
/// y = U^T M^{-1/2} p it is sum_k (y_k^2 + omega_k^2 x_k^2)/2. Of U only entries that are not zero are kept:
/// the modes of many systems are local.
class quadratic_part {
 public:
  /// An entry of U, not zero, with the mass m of its coordinate.
  struct entry {
    Eigen::Index coordinate;  ///< row of U
    Eigen::Index mode;        ///< column of U
    double heavy;             ///< U m^{1/2}: q to x, and y to p
    double light;             ///< U m^{-1/2}: p to y, and x to q
  };

  /// That of a system, by its modes(). Throws std::invalid_argument unless there is a finite column and a
  /// frequency >= 0 for each coordinate.
  template <System S>
  static std::shared_ptr<const quadratic_part> of(const S& system) {
    const normal_modes modes = system.modes();
    const Eigen::Index n = size(system);
    if (modes.basis.rows() != n || modes.basis.cols() != n || modes.frequencies.size() != n ||
        !modes.basis.allFinite() || !modes.frequencies.allFinite() ||
        (modes.frequencies.array() < 0.0).any()) {
      throw std::invalid_argument(
          sentence("the modes of {} must be a finite {} x {} basis with a frequency >= 0 for each",
                   describe(system), n, n));
    }
    auto result = std::make_shared<quadratic_part>();
    result->frequencies_.assign(modes.frequencies.begin(), modes.frequencies.end());
    for (Eigen::Index i = 0; i < n; ++i) {
      double root = 1.0;
      if constexpr (HasInverseMass<S>) root = std::sqrt(1.0 / system.inverse_mass(i));
      for (Eigen::Index k = 0; k < n; ++k) {
        const double u = modes.basis(i, k);
        if (u != 0.0) result->entries_.push_back({i, k, u * root, u / root});
      }
    }
    return result;
  }

  const std::vector<entry>& entries() const { return entries_; }           ///< row by row of U
  const std::vector<double>& frequencies() const { return frequencies_; }  ///< omega_k

 private:
  std::vector<entry> entries_;
  std::vector<double> frequencies_;
};

}  // namespace nysalt
