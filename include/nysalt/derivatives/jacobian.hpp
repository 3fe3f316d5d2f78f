// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <Eigen/Core>

#include "nysalt/method.hpp"
#include "nysalt/phase_point.hpp"
#include "nysalt/scalars/dual.hpp"

namespace nysalt {

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
template <System S, Method M>
auto step_map(const S& system, const M& method, double step) {
  return [stepper = make_stepper(system, method, step)](auto& x) { stepper.step(x); };
}
template <System S, Method M>
void step_map(const S&& system, const M& method, double step) = delete;  // it would refer to a temporary

}  // namespace nysalt
