// SPDX-License-Identifier: BSL-1.0
// From a start to the minimum of a loss: Ceres, then Newton's method for the last digits.
#pragma once

#include <ceres/cost_function.h>
#include <ceres/manifold.h>
#include <ceres/problem.h>
#include <ceres/solver.h>

#include <cmath>
#include <vector>

#include "nysalt/family.hpp"
#include "nysalt/learning/curvature.hpp"

namespace nysalt {

/// Within the open ranges: beyond them the coefficients are not defined.
template <Family F>
bool is_defined(const parameters_of<F>& theta) {
  const auto ranges = F::ranges();
  for (std::size_t k = 0; k < theta.size(); ++k) {
    if (ranges[k].open && !ranges[k].contains(theta[k])) return false;
  }
  return true;
}

/// One block of a loss as a Ceres cost, differentiated automatically through the stepping code. Points
/// outside an open range, or where the step is not finite, are rejected.
template <class Loss>
class block_cost final : public ceres::CostFunction {
 public:
  block_cost(const Loss& loss, std::size_t block) : loss_(&loss), block_(block) {
    set_num_residuals(static_cast<int>(loss.residuals(block)));
    mutable_parameter_block_sizes()->push_back(parameters_v<Loss>);
  }

  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override {
    using D = dual<double, parameters_v<Loss>>;
    theta_of<Loss> theta;
    std::array<D, theta_of<Loss>{}.size()> lifted;
    for (std::size_t k = 0; k < theta.size(); ++k) {
      theta[k] = blocks[0][k];
      lifted[k] = D::variable(theta[k], static_cast<int>(k));
    }
    if (!is_defined<typename Loss::family>(theta)) return false;
    const auto count = static_cast<std::size_t>(num_residuals());
    if (jacobians == nullptr || jacobians[0] == nullptr) {
      loss_->template evaluate<double>(block_, theta, residuals);
    } else {
      std::vector<D> r(count);
      loss_->template evaluate<D>(block_, lifted, r.data());
      for (std::size_t i = 0; i < count; ++i) {
        residuals[i] = r[i].value;
        for (std::size_t k = 0; k < theta.size(); ++k)
          jacobians[0][i * theta.size() + k] = r[i].derivative[k];
      }
    }
    for (std::size_t i = 0; i < count; ++i) {
      if (!std::isfinite(residuals[i])) return false;
    }
    return true;
  }

 private:
  const Loss* loss_;
  std::size_t block_;
};

template <class Loss>
struct minimum {
  theta_of<Loss> theta;
  int iterations = 0;
  bool converged = false;
};

/// Minimises over the free parameters. The loss is flat along a valley, on which Gauss-Newton steps are
/// short: so the search does not end on small changes of the loss, but on small steps, and Newton steps
/// with the full Hessian follow. Converged: another Newton step would lower the loss by less than 1e-6
/// of itself.
template <class Loss>
minimum<Loss> minimise(const Loss& loss, const theta_of<Loss>& start, const std::vector<Eigen::Index>& free,
                       int max_iterations) {
  minimum<Loss> result{start};
  auto& theta = result.theta;
  if (free.empty()) {
    result.converged = true;
    return result;
  }

  ceres::Problem problem;
  for (std::size_t block = 0; block < loss.blocks(); ++block) {
    problem.AddResidualBlock(new block_cost<Loss>(loss, block), nullptr, theta.data());
  }
  std::vector<int> fixed;
  for (int k = 0; k < parameters_v<Loss>; ++k) {
    if (std::find(free.begin(), free.end(), k) == free.end()) fixed.push_back(k);
  }
  if (!fixed.empty()) {
    problem.SetManifold(theta.data(), new ceres::SubsetManifold(parameters_v<Loss>, fixed));
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = max_iterations;
  options.function_tolerance = 0.0;
  options.gradient_tolerance = 0.0;
  options.parameter_tolerance = 1e-8;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  result.iterations = static_cast<int>(summary.iterations.size());

  const curvature bend(hessian(loss, theta), free);
  if (!bend.is_minimum()) return result;
  const auto newton_step = [&](const theta_of<Loss>& at, double& decrease) {
    const Eigen::VectorXd gradient = loss_gradient(loss, at);
    const Eigen::VectorXd step = bend.solve(gradient);
    decrease = 0.5 * gradient.dot(step);
    return step;
  };
  double decrease = 0.0;
  Eigen::VectorXd step = newton_step(theta, decrease);
  for (int n = 0; n < 8 && decrease > 0.0; ++n) {
    auto next = theta;
    for (std::size_t k = 0; k < next.size(); ++k) next[k] -= step[static_cast<Eigen::Index>(k)];
    if (!is_defined<typename Loss::family>(next)) break;
    double next_decrease = 0.0;
    const Eigen::VectorXd next_step = newton_step(next, next_decrease);
    if (!(next_decrease < decrease)) break;  // rounding is reached
    theta = next;
    step = next_step;
    decrease = next_decrease;
    ++result.iterations;
  }
  // 1e-24: errors of 1e-12 of an increment, which exact recovery cannot get below.
  result.converged = decrease <= 1e-6 * loss_value(loss, theta) + 1e-24;
  return result;
}

}  // namespace nysalt
