// SPDX-License-Identifier: BSL-1.0
// What a step is: symplectic, reversible.
#pragma once

#include <Eigen/Core>
#include <algorithm>

#include "nysalt/method.hpp"
#include "nysalt/phase_point.hpp"
#include "nysalt/scalars/dual.hpp"
#include "nysalt/system.hpp"

namespace nysalt {

namespace detail {

/// Exact Jacobian of a map of phase space at x, rows and columns ordered (q, p). The map takes a
/// phase_point<dual<double, 1>, N>& and changes it in place. Cost: 2 N evaluations of the map.
template <int N>
Eigen::MatrixXd jacobian(const auto& map, const phase_point<double, N>& x) {
  using D = dual<double, 1>;
  const Eigen::Index n = x.size();
  Eigen::MatrixXd result(2 * n, 2 * n);
  for (Eigen::Index column = 0; column < 2 * n; ++column) {
    auto y = x.template cast<D>();
    (column < n ? y.q[column] : y.p[column - n]).derivative[0] = 1.0;
    map(y);
    for (Eigen::Index i = 0; i < n; ++i) {
      result(i, column) = y.q[i].derivative[0];
      result(n + i, column) = y.p[i].derivative[0];
    }
  }
  return result;
}

/// One plain step of a method as a map of phase space, over any scalar.
template <System S>
auto step_map(const S& system, const method& method, double step) {
  return [stepper = make_stepper(system, method, step)](auto& x) { stepper.step(x); };
}
template <System S>
void step_map(const S&& system, const method& method,
              double step) = delete;  // it would refer to a temporary

/// Omega of the symplectic form in (q, p), of 2 n rows.
inline Eigen::MatrixXd symplectic_form(Eigen::Index n) {
  Eigen::MatrixXd omega = Eigen::MatrixXd::Zero(2 * n, 2 * n);
  omega.topRightCorner(n, n).setIdentity();
  omega.bottomLeftCorner(n, n).diagonal().setConstant(-1.0);
  return omega;
}

}  // namespace detail

/// Largest entry of J^T Omega J - Omega with the exact Jacobian J of a map at x: zero to rounding if and
/// only if the map is symplectic there [hairer_lubich_wanner_2006, definition VI.2.2].
template <int N>
double symplecticity_defect(const auto& map, const phase_point<double, N>& x) {
  const Eigen::MatrixXd omega = detail::symplectic_form(x.size());
  const Eigen::MatrixXd j = detail::jacobian(map, x);
  return (j.transpose() * omega * j - omega).cwiseAbs().maxCoeff();
}

/// Symplecticity defect of one step of a method.
template <System S>
double symplecticity_defect(const S& system, const method& method, double step,
                            const phase_point<double, S::dimension>& x) {
  return symplecticity_defect(detail::step_map(system, method, step), x);
}

/// Largest coordinate of R Phi R Phi(x) - x with R(q, p) = (q, -p): zero to rounding for reversible maps
/// [hairer_lubich_wanner_2006, definition V.1.2].
template <int N>
double reversibility_defect(const auto& map, const phase_point<double, N>& x) {
  auto y = x;
  for (int half = 0; half < 2; ++half) {
    map(y);
    y.p = (-y.p).eval();
  }
  return std::max((y.q - x.q).cwiseAbs().maxCoeff(), (y.p - x.p).cwiseAbs().maxCoeff());
}

/// Reversibility defect of one step of a method.
template <System S>
double reversibility_defect(const S& system, const method& method, double step,
                            const phase_point<double, S::dimension>& x) {
  return reversibility_defect(detail::step_map(system, method, step), x);
}

}  // namespace nysalt
