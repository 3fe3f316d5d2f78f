// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "nysalt/core/fingerprint.hpp"
#include "nysalt/core/sentence.hpp"
#include "nysalt/systems/modal_coordinates.hpp"

namespace nysalt {

/// H = sum p_i^2/(2 m_i) + q^T K q/2 with any symmetric, positive semidefinite stiffness matrix K and
/// any masses m_i > 0.
class linear_chain {
 public:
  static constexpr int dimension = Eigen::Dynamic;

  /// Unit masses unless given. Throws std::invalid_argument if K is empty, not square, not finite,
  /// not symmetric or has a negative eigenvalue, or if the masses do not fit or are not positive.
  explicit linear_chain(Eigen::MatrixXd stiffness, Eigen::VectorXd masses = {})
      : stiffness_(std::move(stiffness)), inverse_masses_(std::move(masses)) {
    const auto n = stiffness_.rows();
    if (inverse_masses_.size() == 0) inverse_masses_ = Eigen::VectorXd::Ones(n);
    if (n > 0 && (inverse_masses_.size() != n || !(inverse_masses_.minCoeff() > 0.0) ||
                  !inverse_masses_.allFinite())) {
      throw std::invalid_argument(
          sentence("linear_chain: masses must be positive and finite, {} of them", n));
    }
    inverse_masses_ = inverse_masses_.cwiseInverse();
    modes_ = detail::stiffness_modes(stiffness_, inverse_masses_, "linear_chain");
    for (Eigen::Index j = 0; j < n; ++j) rows_.push_back(rows_of_column(j));
    description_ = sentence("linear_chain(masses={}, omega_max={}, fingerprint={})", n,
                            modes_.frequencies.maxCoeff(), fingerprint());
  }

  /// Equal masses in a row, each joined to its neighbours and the walls by springs of one stiffness.
  /// Throws std::invalid_argument unless there is a mass, and spring and mass are positive and finite.
  static linear_chain between_walls(Eigen::Index masses, double spring, double mass = 1.0) {
    if (masses < 1) {
      throw std::invalid_argument(
          sentence("linear_chain: at least one mass must be between the walls, got {}", masses));
    }
    if (!(spring > 0.0) || !(mass > 0.0) || !std::isfinite(spring) || !std::isfinite(mass)) {
      throw std::invalid_argument(
          sentence("linear_chain: spring and mass must be positive and finite, got {} and {}", spring, mass));
    }
    Eigen::MatrixXd stiffness = Eigen::MatrixXd::Zero(masses, masses);
    stiffness.diagonal().setConstant(2.0 * spring);
    stiffness.diagonal(1).setConstant(-spring);
    stiffness.diagonal(-1).setConstant(-spring);
    return linear_chain(std::move(stiffness), Eigen::VectorXd::Constant(masses, mass));
  }

  Eigen::Index size() const { return stiffness_.rows(); }
  double inverse_mass(Eigen::Index i) const { return inverse_masses_[i]; }

  template <class T>
  T potential(const vector<T, dimension>& q) const {
    T sum(0.0);
    for (Eigen::Index j = 0; j < size(); ++j) {
      const auto [first, end] = rows_[static_cast<std::size_t>(j)];
      for (Eigen::Index i = first; i < end; ++i) sum += q[i] * q[j] * (0.5 * stiffness_(i, j));
    }
    return sum;
  }
  /// Cost: two operations for each entry of K between the first and the last of a column that are not zero.
  template <class T>
  void force(const vector<T, dimension>& q, vector<T, dimension>& f) const {
    for (Eigen::Index i = 0; i < size(); ++i) f[i] = T(0.0);
    for (Eigen::Index j = 0; j < size(); ++j) {
      const auto [first, end] = rows_[static_cast<std::size_t>(j)];
      for (Eigen::Index i = first; i < end; ++i) f[i] -= q[j] * stiffness_(i, j);
    }
  }

  /// Zero: all of V is quadratic.
  template <class T>
  void soft_force(const vector<T, dimension>&, vector<T, dimension>& f) const {
    for (Eigen::Index i = 0; i < size(); ++i) f[i] = T(0.0);
  }

  normal_modes modes() const { return modes_; }
  std::vector<frequency_band> frequency_bands() const {
    return {{modes_.frequencies.minCoeff(), modes_.frequencies.maxCoeff()}};
  }
  /// Made once: references and methods ask for it often, and it takes all entries of K.
  std::string description() const { return description_; }

 private:
  /// Fingerprint of K, by columns, and the inverse masses, which distinguishes chains of one size.
  std::string fingerprint() const {
    detail::fingerprint sum;
    sum.add_all(stiffness_.reshaped());
    sum.add_all(inverse_masses_);
    return sum.text();
  }

  struct row_range {
    Eigen::Index first;
    Eigen::Index end;
  };
  /// The rows from the first non-zero entry of column j to the last; none if all are zero.
  row_range rows_of_column(Eigen::Index j) const {
    row_range rows{0, size()};
    while (rows.first < rows.end && stiffness_(rows.first, j) == 0.0) ++rows.first;
    while (rows.first < rows.end && stiffness_(rows.end - 1, j) == 0.0) --rows.end;
    return rows;
  }

  Eigen::MatrixXd stiffness_;
  std::vector<row_range> rows_;  // of each column of K
  Eigen::VectorXd inverse_masses_;
  normal_modes modes_;
  std::string description_;
};

}  // namespace nysalt
