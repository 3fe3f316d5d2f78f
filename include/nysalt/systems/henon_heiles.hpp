// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "nysalt/system.hpp"

namespace nysalt {

/// H = (p_1^2 + p_2^2)/2 + (q_1^2 + q_2^2)/2 + q_1^2 q_2 - q_2^3/3, bounded below energy 1/6
/// [henon_heiles_1964].
struct henon_heiles {
  static constexpr int dimension = 2;

  template <class T>
  T potential(const vector<T, 2>& q) const {
    return (q[0] * q[0] + q[1] * q[1]) * 0.5 + q[0] * q[0] * q[1] - q[1] * q[1] * q[1] * (1.0 / 3.0);
  }
  template <class T>
  void force(const vector<T, 2>& q, vector<T, 2>& f) const {
    f[0] = -q[0] - q[0] * q[1] * 2.0;
    f[1] = -q[1] - q[0] * q[0] + q[1] * q[1];
  }

  /// The force of the cubic part only.
  template <class T>
  void soft_force(const vector<T, 2>& q, vector<T, 2>& f) const {
    f[0] = q[0] * q[1] * -2.0;
    f[1] = q[1] * q[1] - q[0] * q[0];
  }

  /// Both modes of the quadratic part have frequency 1.
  normal_modes modes() const { return {Eigen::MatrixXd::Identity(2, 2), Eigen::VectorXd::Ones(2)}; }
  /// The Hessian has eigenvalues 1 +- 2 |q|, and |q| <= 1 on bounded orbits.
  std::vector<frequency_band> frequency_bands() const { return {{0.0, std::sqrt(3.0)}}; }
  std::string description() const { return "henon_heiles()"; }
};

}  // namespace nysalt
