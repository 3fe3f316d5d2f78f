// SPDX-License-Identifier: BSL-1.0
// The one-step loss of a family that is a type, with theta as the family holds it.
#pragma once

#include <functional>
#include <vector>

#include "nysalt/learning/curvature.hpp"
#include "nysalt/losses/after_steps.hpp"
#include "nysalt/losses/state_error.hpp"

namespace nysalt::test {

template <Family F, Scalar R = detail::lanes>
struct one_step : after_steps<R> {
  one_step(const model& system, const flow_map_data& data, const metric& measure, int threads = 1)
      : after_steps<R>(run_time_family(F()), system, data, state_error<R>(measure), {.threads = threads}) {}
};

template <Family F, Scalar R>
double loss_value(const one_step<F, R>& loss, const parameters_of<F>& theta) {
  return nysalt::loss_value(loss, column_of(theta));
}
template <Family F, Scalar R>
std::vector<double> trajectory_losses(const one_step<F, R>& loss, const parameters_of<F>& theta) {
  return nysalt::trajectory_losses(loss, column_of(theta));
}
template <Family F, Scalar R>
std::vector<Eigen::VectorXd> trajectory_gradients(const one_step<F, R>& loss, const parameters_of<F>& theta) {
  return nysalt::trajectory_gradients(loss, column_of(theta));
}
template <Family F, Scalar R>
std::vector<Eigen::MatrixXd> residual_gradients(const one_step<F, R>& loss, const parameters_of<F>& theta) {
  return nysalt::residual_gradients(loss, column_of(theta));
}
template <Family F, Scalar R>
squares squares_at(const one_step<F, R>& loss, const parameters_of<F>& theta) {
  return nysalt::squares_at(loss, column_of(theta));
}
template <Family F, Scalar R>
Eigen::MatrixXd hessian(const one_step<F, R>& loss, const parameters_of<F>& theta) {
  return nysalt::hessian(loss, column_of(theta));
}

/// Where the coefficients of a family are defined.
template <Family F>
std::function<bool(const Eigen::VectorXd&)> defined_for() {
  return [family = run_time_family(F())](const Eigen::VectorXd& theta) { return family.is_defined(theta); };
}

}  // namespace nysalt::test
