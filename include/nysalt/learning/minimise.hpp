// SPDX-License-Identifier: BSL-1.0
// From a start to the minimum of a loss: Ceres, then Newton's method for the last digits.
#pragma once

#include <ceres/manifold.h>
#include <ceres/problem.h>
#include <ceres/solver.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <vector>

#include "nysalt/learning/compressed_cost.hpp"
#include "nysalt/learning/curvature.hpp"

namespace nysalt {

/// Where a search ended.
struct minimum {
  Eigen::VectorXd theta;      ///< all parameters, those that are not free too
  double loss = 0.0;          ///< the loss at theta
  Eigen::MatrixXd hessian{};  ///< of the loss at theta, by all parameters
  int iterations = 0;         ///< of Ceres and of Newton's method together
  bool converged = false;     ///< another Newton step would lower the loss by less than 1e-6 of itself
  bool has_ended = false;     ///< whether Ceres ended by itself, and was not cut short
  bool in_valley = false;     ///< it did not converge, but further iterations hardly lower the loss
};

namespace detail {

/// Ceres from theta, which becomes where it ends; parameters that are not free stay. The loss is flat along
/// a valley, on which Gauss-Newton steps are short: so the search does not end on small changes of the loss,
/// but on small steps. Where it does not end so, the last quarter of the iterations tells a valley.
inline void descend(ceres::Problem& problem, const std::vector<Eigen::Index>& free, int max_iterations,
                    minimum& found) {
  Eigen::VectorXd& theta = found.theta;
  std::vector<int> fixed;
  for (Eigen::Index k = 0; k < theta.size(); ++k) {
    if (std::find(free.begin(), free.end(), k) == free.end()) fixed.push_back(static_cast<int>(k));
  }
  if (!fixed.empty()) {
    problem.SetManifold(theta.data(), new ceres::SubsetManifold(static_cast<int>(theta.size()), fixed));
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
  found.iterations = static_cast<int>(summary.iterations.size());
  found.has_ended = summary.termination_type == ceres::CONVERGENCE;
  const auto& steps = summary.iterations;
  constexpr double hardly = 1.1;  // by a tenth
  constexpr std::size_t enough = 50;
  found.in_valley = summary.termination_type == ceres::NO_CONVERGENCE && steps.size() > enough &&
                    steps[steps.size() * 3 / 4].cost <= hardly * steps.back().cost;
}

/// Newton steps with the Hessian of where they begin, until rounding is reached; then it is that of the end,
/// to a part in a million.
inline void polish(const objective& loss, const std::function<bool(const Eigen::VectorXd&)>& defined,
                   const std::vector<Eigen::Index>& free, minimum& found) {
  const Eigen::VectorXd began = found.theta;
  found.hessian = hessian(loss, began);
  const curvature bend(found.hessian, free);
  squares here = loss(began);
  found.loss = here.value;
  if (!bend.is_minimum()) return;
  const auto decrease_of = [&](const squares& at) {  // by the next step
    const Eigen::VectorXd gradient = at.gradient();
    return 0.5 * gradient.dot(bend.solve(gradient));
  };
  double decrease = decrease_of(here);
  for (int n = 0; n < 8 && decrease > 0.0; ++n) {
    const Eigen::VectorXd next = found.theta - bend.solve(here.gradient());
    if (!defined(next)) break;
    const squares there = loss(next);
    const double next_decrease = decrease_of(there);
    if (!(next_decrease < decrease)) break;
    found.theta = next;
    here = there;
    decrease = next_decrease;
    ++found.iterations;
  }
  found.loss = here.value;
  if ((found.theta - began).norm() > 1e-6) found.hessian = hessian(loss, found.theta);
  // 1e-24: errors of 1e-12 of an increment, which exact recovery cannot get below.
  found.converged = decrease <= 1e-6 * found.loss + 1e-24;
  constexpr double hardly = 0.005;  // so that the loss is within a hundredth of the least
  found.in_valley =
      !found.converged && (found.in_valley || (found.has_ended && decrease <= hardly * found.loss));
}

}  // namespace detail

/// Minimises over the free parameters. Converged: another Newton step would lower the loss by less than 1e-6
/// of itself. From a start that is not defined, or whose loss is not finite, it goes nowhere, and the loss is
/// infinite: Ceres would say so on the standard error stream.
inline minimum minimise(const objective& loss, const std::function<bool(const Eigen::VectorXd&)>& defined,
                        const Eigen::VectorXd& start, const std::vector<Eigen::Index>& free,
                        int max_iterations) {
  minimum found{start};
  if (free.empty()) {
    found.loss = loss(start).value;
    found.hessian = Eigen::MatrixXd::Zero(start.size(), start.size());  // nobody asks in which direction
    found.converged = true;
    return found;
  }
  auto cost = std::make_unique<compressed_cost>(loss, defined, static_cast<int>(start.size()));
  if (!cost->is_usable_at(start)) {
    found.loss = std::numeric_limits<double>::infinity();
    found.hessian = Eigen::MatrixXd::Zero(start.size(), start.size());
    return found;
  }
  ceres::Problem problem;
  problem.AddResidualBlock(cost.release(), nullptr, found.theta.data());
  detail::descend(problem, free, max_iterations, found);
  detail::polish(loss, defined, free, found);
  return found;
}

}  // namespace nysalt
