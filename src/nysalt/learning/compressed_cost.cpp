// SPDX-License-Identifier: BSL-1.0
// The few residuals that have the loss, gradient and normal matrix of many.
#include "nysalt/learning/compressed_cost.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <utility>

namespace nysalt {

compressed_cost::compressed_cost(objective loss, std::function<bool(const Eigen::VectorXd&)> defined,
                                 int parameters)
    : loss_(std::move(loss)), defined_(std::move(defined)), parameters_(parameters) {}

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
  const Eigen::Index count = parameters_;
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

}  // namespace nysalt
