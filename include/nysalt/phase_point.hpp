// SPDX-License-Identifier: BSL-1.0
// A point of phase space.
#pragma once

#include <Eigen/Core>

#include "nysalt/scalar.hpp"

namespace nysalt {

/// A column of N scalars, N fixed or Eigen::Dynamic.
template <class T, int N>
using vector = Eigen::Matrix<T, N, 1>;

/// Positions q and momenta p of one state, each of the system's dimension.
template <Scalar T, int N>
struct phase_point {
  using scalar_type = T;               ///< type of each entry
  static constexpr int dimension = N;  ///< N, fixed or Eigen::Dynamic

  vector<T, N> q;  ///< positions, one for each degree of freedom
  vector<T, N> p;  ///< momenta (not velocities), likewise

  Eigen::Index size() const { return q.size(); }  ///< degrees of freedom

  /// The state in another scalar type, as constants.
  template <Scalar U>
  phase_point<U, N> cast() const {
    phase_point<U, N> result{vector<U, N>(size()), vector<U, N>(size())};
    for (Eigen::Index i = 0; i < size(); ++i) {
      result.q[i] = U(q[i]);
      result.p[i] = U(p[i]);
    }
    return result;
  }
};

/// No NaN and no infinity in q and p.
template <int N>
bool is_finite(const phase_point<double, N>& x) {
  return x.q.allFinite() && x.p.allFinite();
}

}  // namespace nysalt
