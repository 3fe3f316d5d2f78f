// SPDX-License-Identifier: BSL-1.0
// Maps of a plane, and the covariances that they keep with noise.
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <limits>

#include "nysalt/scalar.hpp"

namespace nysalt::detail {

/// A map of (x, y), or a covariance of both.
template <Scalar T>
using plane = Eigen::Matrix<T, 2, 2>;

/// The covariance C after the map M: M C M^T, symmetric to the last bit.
template <Scalar T>
plane<T> congruence(const plane<T>& M, const plane<T>& C) {
  plane<T> result = (M * C).eval() * M.transpose();
  result(0, 1) = result(1, 0);
  return result;
}

/// S S^T - 1, which S adds to the covariance 1, if S has determinant 1. Its trace is written as squares,
/// which vanish to twice as many digits where S is a rotation: weak friction magnifies an error of the trace
/// by 1/(gamma h), and of the rest by no more than 1/(1 - |trace S|/2).
template <Scalar T>
plane<T> excess_of_turn(const plane<T>& S) {
  const T diagonal = S(0, 0) - S(1, 1);
  const T shear = S(0, 1) + S(1, 0);
  const T sum = diagonal * diagonal + shear * shear;
  const T difference = (S(0, 0) * S(0, 0) - S(1, 1) * S(1, 1)) + (S(0, 1) * S(0, 1) - S(1, 0) * S(1, 0));
  const T covariance = S(0, 0) * S(1, 0) + S(0, 1) * S(1, 1);
  return plane<T>{{(sum + difference) * 0.5, covariance}, {covariance, (sum - difference) * 0.5}};
}

/// Infinite: the value where there is no such covariance.
template <Scalar T>
plane<T> no_covariance() {
  return plane<T>::Constant(T(std::numeric_limits<double>::infinity()));
}

/// The D with D = M D M^T + R; infinite unless M is Schur stable: both
/// eigenvalues lie inside the unit circle (Schur, Cohn and Jury). With L the map D -> M D M^T, whose
/// eigenvalues are d, the determinant of M, and the squares of its two, Cayley-Hamilton says L^3 - e L^2 + d
/// e L - d^3 = 0 with e = t^2 - d, t the trace. Dividing by L - 1 gives
///   D = (L^2 + (1 - e) L + 1 - e + d e) R / ((1 - d) (1 + d - t) (1 + d + t)).
/// Rounding errs by some eps |R| over that denominator.
template <Scalar T>
plane<T> discrete_lyapunov(const plane<T>& M, const plane<T>& R) {
  const T d = M.determinant();
  const T t = M.trace();
  if (!(d < T(1.0) && d > T(-1.0) && t < d + 1.0 && -t < d + 1.0)) return no_covariance<T>();
  const T e = t * t - d;
  const T denominator = (1.0 - d) * (d + 1.0 - t) * (d + 1.0 + t);
  const auto once = congruence(M, R);
  const auto twice = congruence(M, once);
  return (twice + once * (1.0 - e) + R * (1.0 - e + d * e)) * (1.0 / denominator);
}

}  // namespace nysalt::detail
