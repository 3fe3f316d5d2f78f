// SPDX-License-Identifier: BSL-1.0

#include "minimise.hpp"

#include <ceres/manifold.h>
#include <ceres/problem.h>
#include <ceres/solver.h>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "curvature.hpp"

// The few residuals that have the loss, gradient and normal matrix of many.

namespace nysalt {

compressed_cost::compressed_cost(objective loss, theta_condition defined, int parameters)
    : loss_(std::move(loss)), defined_(std::move(defined)) {
  set_num_residuals(parameters + 1);
  mutable_parameter_block_sizes()->push_back(parameters);
}

bool compressed_cost::is_usable_at(const Eigen::VectorXd& theta) const {
  if (!defined_(theta)) return false;
  if (theta_.size() == 0 || theta != theta_) {
    at_theta_ = loss_(theta);
    theta_ = theta;
    compress();
  }
  return at_theta_.is_finite() && residuals_.allFinite() && jacobian_.allFinite();
}

bool compressed_cost::Evaluate(double const* const* blocks, double* residuals, double** jacobians) const {
  const Eigen::Index count = num_residuals() - 1;
  if (!is_usable_at(Eigen::Map<const Eigen::VectorXd>(blocks[0], count))) return false;
  if (jacobians != nullptr && jacobians[0] != nullptr) {
    std::copy_n(residuals_.data(), count + 1, residuals);
    std::copy_n(jacobian_.data(), (count + 1) * count, jacobians[0]);
  } else {
    std::fill(residuals, residuals + count, 0.0);
    residuals[count] = std::sqrt(at_theta_.value);
  }
  return true;
}

void compressed_cost::compress() const {
  const Eigen::Index count = theta_.size();
  residuals_ = Eigen::VectorXd::Zero(count + 1);
  jacobian_ = rows::Zero(count + 1, count);
  if (!at_theta_.is_finite()) return;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(at_theta_.normal_matrix);
  const double least = 1e-13 * solver.eigenvalues()[count - 1];
  double rest = at_theta_.value;
  for (Eigen::Index k = 0; k < count; ++k) {
    const double root = std::sqrt(solver.eigenvalues()[k]);
    if (!(root * root > least)) continue;
    const auto direction = solver.eigenvectors().col(k);
    residuals_[k] = direction.dot(at_theta_.half_gradient) / root;
    jacobian_.row(k) = root * direction;
    rest -= residuals_[k] * residuals_[k];
  }
  residuals_[count] = std::sqrt(std::max(0.0, rest));  // negative by rounding, where all is explained
}

// The minimum of a loss: Ceres, then Newton's method for the last digits.

namespace detail {

void descend(ceres::Problem& problem, const std::vector<Eigen::Index>& free, const descent& how,
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
  options.max_num_iterations = how.max_iterations;
  options.function_tolerance = how.function_tolerance;
  options.gradient_tolerance = 0.0;
  options.parameter_tolerance = 1e-8;
  options.use_nonmonotonic_steps = how.may_climb;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  found.iterations = static_cast<int>(summary.iterations.size());
  found.has_ended = summary.termination_type == ceres::CONVERGENCE;
  const auto& steps = summary.iterations;
  constexpr double hardly = 2.0;  // errors by a factor 1.4, as much as one search and another differ
  constexpr std::size_t enough = 50;
  found.in_valley = summary.termination_type == ceres::NO_CONVERGENCE && steps.size() > enough &&
                    steps[steps.size() * 3 / 4].cost <= hardly * summary.final_cost;
}

void polish(const objective& loss, const theta_condition& defined, const std::vector<Eigen::Index>& free,
            minimum& found) {
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

namespace {

/// descend() from theta; false from where the loss is not usable.
bool descend_by_few_residuals(const objective& loss, const theta_condition& defined,
                              const std::vector<Eigen::Index>& free, const detail::descent& how,
                              minimum& found) {
  auto cost = std::make_unique<compressed_cost>(loss, defined, static_cast<int>(found.theta.size()));
  if (!cost->is_usable_at(found.theta)) {
    found.loss = std::numeric_limits<double>::infinity();
    return false;
  }
  if (free.empty()) return true;
  ceres::Problem problem;
  problem.AddResidualBlock(cost.release(), nullptr, found.theta.data());
  detail::descend(problem, free, how, found);
  return true;
}

}  // namespace

std::pair<Eigen::VectorXd, double> descend_roughly(const objective& loss, const theta_condition& defined,
                                                   const Eigen::VectorXd& start,
                                                   const std::vector<Eigen::Index>& free, bool may_climb) {
  const detail::descent roughly{.max_iterations = 40, .function_tolerance = 0.01, .may_climb = may_climb};
  minimum found{start};
  if (!descend_by_few_residuals(loss, defined, free, roughly, found)) {
    return {start, found.loss};
  }
  return {found.theta, loss(found.theta).value};
}

minimum minimise(const objective& loss, const theta_condition& defined, const Eigen::VectorXd& start,
                 const std::vector<Eigen::Index>& free, int max_iterations) {
  minimum found{start};
  found.hessian = Eigen::MatrixXd::Zero(start.size(), start.size());  // where the direction is not needed
  if (free.empty()) {
    found.loss = loss(start).value;
    found.converged = true;
  } else if (descend_by_few_residuals(loss, defined, free, {max_iterations}, found)) {
    detail::polish(loss, defined, free, found);
  }
  return found;
}

}  // namespace nysalt
