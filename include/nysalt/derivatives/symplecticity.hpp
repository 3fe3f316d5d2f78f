// SPDX-License-Identifier: BSL-1.0
#pragma once

#include "nysalt/derivatives/jacobian.hpp"

namespace nysalt {

/// Largest entry of J^T Omega J - Omega with the exact Jacobian J of a map at x: zero to rounding if and
/// only if the map is symplectic there [hairer_lubich_wanner_2006, definition VI.2.2].
template <int N>
double symplecticity_defect(const auto& map, const phase_point<double, N>& x) {
  const Eigen::Index n = x.size();
  Eigen::MatrixXd omega = Eigen::MatrixXd::Zero(2 * n, 2 * n);
  omega.topRightCorner(n, n).setIdentity();
  omega.bottomLeftCorner(n, n).diagonal().setConstant(-1.0);
  const Eigen::MatrixXd j = jacobian(map, x);
  return (j.transpose() * omega * j - omega).cwiseAbs().maxCoeff();
}

/// Symplecticity defect of one step of a method.
template <System S, Method M>
double symplecticity_defect(const S& system, const M& method, double step,
                            const phase_point<double, S::dimension>& x) {
  return symplecticity_defect(step_map(system, method, step), x);
}

}  // namespace nysalt
