// SPDX-License-Identifier: BSL-1.0
// The covariance that a linear step with noise keeps, in the plane.
#pragma once

#include <limits>

#include "nysalt/scalar.hpp"

namespace nysalt {

/// (x, y) <- (xx x + xy y, yx x + yy y); the identity by default.
template <Scalar T>
struct plane_map {
  T xx{1.0};  ///< matrix entry to x from x
  T xy{0.0};  ///< matrix entry to x from y
  T yx{0.0};  ///< matrix entry to y from x
  T yy{1.0};  ///< matrix entry to y from y

  T trace() const { return xx + yy; }                  ///< sum of the eigenvalues
  T determinant() const { return xx * yy - xy * yx; }  ///< product of the eigenvalues
};

/// First a, then b: the matrix b a.
template <Scalar T>
plane_map<T> compose(const plane_map<T>& a, const plane_map<T>& b) {
  return {b.xx * a.xx + b.xy * a.yx, b.xx * a.xy + b.xy * a.yy,  //
          b.yx * a.xx + b.yy * a.yx, b.yx * a.xy + b.yy * a.yy};
}

/// A symmetric matrix.
template <Scalar T>
struct plane_covariance {
  T xx{0.0};  ///< variance of x
  T xy{0.0};  ///< covariance of x and y
  T yy{0.0};  ///< variance of y

  /// Entry by entry.
  friend plane_covariance operator+(const plane_covariance& a, const plane_covariance& b) {
    return {a.xx + b.xx, a.xy + b.xy, a.yy + b.yy};
  }
  /// Every entry times c.
  friend plane_covariance operator*(const plane_covariance& a, const T& c) {
    return {a.xx * c, a.xy * c, a.yy * c};
  }
};

/// The covariance C after the map M: M C M^T.
template <Scalar T>
plane_covariance<T> congruence(const plane_map<T>& M, const plane_covariance<T>& C) {
  const T to_x_x = M.xx * C.xx + M.xy * C.xy;
  const T to_x_y = M.xx * C.xy + M.xy * C.yy;
  const T to_y_x = M.yx * C.xx + M.yy * C.xy;
  const T to_y_y = M.yx * C.xy + M.yy * C.yy;
  return {to_x_x * M.xx + to_x_y * M.xy, to_x_x * M.yx + to_x_y * M.yy, to_y_x * M.yx + to_y_y * M.yy};
}

/// S S^T - 1, which S adds to the covariance 1, if S has determinant 1. Its trace is written as squares,
/// which vanish to twice as many digits where S is a rotation: weak friction magnifies an error of the trace
/// by 1/(gamma h), and of the rest by no more than 1/(1 - |trace S|/2).
template <Scalar T>
plane_covariance<T> excess_of_turn(const plane_map<T>& S) {
  const T diagonal = S.xx - S.yy;
  const T shear = S.xy + S.yx;
  const T sum = diagonal * diagonal + shear * shear;
  const T difference = (S.xx * S.xx - S.yy * S.yy) + (S.xy * S.xy - S.yx * S.yx);
  return {(sum + difference) * 0.5, S.xx * S.yx + S.xy * S.yy, (sum - difference) * 0.5};
}

/// Whether both eigenvalues lie inside the unit circle (Schur, Cohn and Jury).
template <Scalar T>
bool is_schur_stable(const plane_map<T>& M) {
  const T d = M.determinant();
  const T t = M.trace();
  return d < T(1.0) && d > T(-1.0) && t < d + 1.0 && -t < d + 1.0;
}

/// Infinite: the value where there is no such covariance.
template <Scalar T>
plane_covariance<T> no_covariance() {
  const T infinity(std::numeric_limits<double>::infinity());
  return {infinity, infinity, infinity};
}

/// The D with D = M D M^T + R; infinite unless M is Schur stable. With L the map D -> M D M^T, whose
/// eigenvalues are d, the determinant of M, and the squares of its two, Cayley-Hamilton says L^3 - e L^2 + d
/// e L - d^3 = 0 with e = t^2 - d, t the trace. Dividing by L - 1 gives
///   D = (L^2 + (1 - e) L + 1 - e + d e) R / ((1 - d) (1 + d - t) (1 + d + t)).
/// Rounding errs by some eps |R| over that denominator.
template <Scalar T>
plane_covariance<T> discrete_lyapunov(const plane_map<T>& M, const plane_covariance<T>& R) {
  if (!is_schur_stable(M)) return no_covariance<T>();
  const T d = M.determinant();
  const T t = M.trace();
  const T e = t * t - d;
  const T denominator = (1.0 - d) * (d + 1.0 - t) * (d + 1.0 + t);
  const auto once = congruence(M, R);
  const auto twice = congruence(M, once);
  return (twice + once * (1.0 - e) + R * (1.0 - e + d * e)) * (1.0 / denominator);
}

}  // namespace nysalt
