// SPDX-License-Identifier: BSL-1.0
// Coordinates in which the quadratic part of a system is a sum of oscillators.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <string_view>
#include <type_traits>
#include <vector>

#include "nysalt/core/sentence.hpp"
#include "nysalt/system.hpp"

// Coordinates in which the quadratic part of a Hamiltonian is a sum of harmonic oscillators.

namespace nysalt {

namespace detail {

/// The modal coordinates x = U^T M^{1/2} q and y = U^T M^{-1/2} p, in which H_0 = p M^-1 p/2 + q K q/2 with
/// K = M^{1/2} U diag(omega^2) U^T M^{1/2} is sum_k (y_k^2 + omega_k^2 x_k^2)/2. Only the non-zero entries of
/// U are stored, because the modes of many systems are local.
class modal_coordinates {
 public:
  /// A non-zero entry of U, with the mass m of the coordinate.
  struct entry {
    Eigen::Index coordinate;  ///< row of U
    Eigen::Index mode;        ///< column of U
    double heavy;             ///< U m^{1/2}: from q to x, and from y to p
    double light;             ///< U m^{-1/2}: from p to y, and from x to q
  };

  /// The modal coordinates of a system that declares modes(). Throws std::invalid_argument unless modes() are
  /// an N x N matrix of finite numbers and N finite frequencies >= 0.
  template <System S>
  static std::shared_ptr<const modal_coordinates> of(const S& system) {
    const normal_modes modes = system.modes();
    const Eigen::Index n = nysalt::size(system);
    const bool are_entries = modes.basis.size() == 0 && !modes.entries.empty();
    const auto is_within = [&](const normal_modes::entry& u) {
      return 0 <= u.coordinate && u.coordinate < n && 0 <= u.mode && u.mode < n && std::isfinite(u.value);
    };
    const bool is_basis = are_entries
                              ? std::ranges::all_of(modes.entries, is_within)
                              : modes.basis.rows() == n && modes.basis.cols() == n && modes.basis.allFinite();
    if (!is_basis || modes.frequencies.size() != n || !modes.frequencies.allFinite() ||
        (modes.frequencies.array() < 0.0).any()) {
      throw std::invalid_argument(
          sentence("the modes of {} must be a finite {} x {} basis with a frequency >= 0 for each",
                   describe(system), n, n));
    }
    auto result = std::make_shared<modal_coordinates>();
    result->frequencies_.assign(modes.frequencies.begin(), modes.frequencies.end());
    const auto root_mass = [&](Eigen::Index i) {
      if constexpr (HasInverseMass<S>) return std::sqrt(1.0 / system.inverse_mass(i));
      return i < 0 ? 0.0 : 1.0;
    };
    for (const auto& [i, k, u] : modes.entries) {
      const double root = root_mass(i);
      result->entries_.push_back({i, k, u * root, u / root});
    }
    for (Eigen::Index i = 0; i < modes.basis.rows(); ++i) {
      const double root = root_mass(i);
      for (Eigen::Index k = 0; k < n; ++k) {
        const double u = modes.basis(i, k);
        if (u != 0.0) result->entries_.push_back({i, k, u * root, u / root});
      }
    }
    return result;
  }

  const std::vector<entry>& entries() const { return entries_; }           ///< row by row of U
  const std::vector<double>& frequencies() const { return frequencies_; }  ///< omega_k
  /// The number of coordinates N.
  Eigen::Index size() const { return static_cast<Eigen::Index>(frequencies_.size()); }

  /// Sets x = U^T M^{1/2} q and y = U^T M^{-1/2} p; all are vectors of N scalars of one type. Each sum runs
  /// over the coordinates in their order. Cost: two products for each entry.
  void to_modes(const auto& q, const auto& p, auto& x, auto& y) const {
    using T = std::remove_cvref_t<decltype(x[0])>;
    for (Eigen::Index k = 0; k < size(); ++k) x[k] = y[k] = T(0.0);
    for (const auto& [i, k, heavy, light] : entries_) {
      x[k] += q[i] * heavy;
      y[k] += p[i] * light;
    }
  }

  /// The inverse of to_modes: sets q = M^{-1/2} U x and p = M^{1/2} U y, for an orthogonal U.
  void from_modes(const auto& x, const auto& y, auto& q, auto& p) const {
    using T = std::remove_cvref_t<decltype(q[0])>;
    for (Eigen::Index i = 0; i < size(); ++i) q[i] = p[i] = T(0.0);
    for (const auto& [i, k, heavy, light] : entries_) {
      q[i] += x[k] * light;
      p[i] += y[k] * heavy;
    }
  }

 private:
  std::vector<entry> entries_;
  std::vector<double> frequencies_;
};

}  // namespace detail

// The modes of a stiffness matrix.

namespace detail {

/// Normal modes of q K q/2 with K symmetric, and masses: M^{-1/2} K M^{-1/2} = U diag(omega^2) U^T. Cost:
/// O(N^3). Throws std::invalid_argument, in the name of who asks, unless K is square, finite and symmetric,
/// and no eigenvalue is negative beyond rounding.
normal_modes stiffness_modes(const Eigen::MatrixXd& stiffness, const Eigen::VectorXd& inverse_masses,
                             std::string_view who);

}  // namespace detail

}  // namespace nysalt
