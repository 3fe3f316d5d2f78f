// SPDX-License-Identifier: BSL-1.0
// A loss of any number of residuals as a Ceres cost with few.
#pragma once

#include <ceres/cost_function.h>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "nysalt/learning/squares.hpp"

namespace nysalt {

/// With J^T J = V D V^T the residuals r' = (D^{-1/2} V^T J^T r, the root of what r^T r has more) and their
/// Jacobian J' = (D^{1/2} V^T, 0) have the loss, gradient and normal matrix of r and J, hence the same steps.
/// Directions with an eigenvalue below 1e-13 of the largest, where it is rounding, are left out: no residual
/// changes along them. Where residuals are small, twice J^T J is the Hessian, so that such a direction is one
/// of the flat ones that `curvature` finds, with a coarser sieve.
///
/// Normal equations square the condition number, which decides how well a step is known and not where the
/// search ends: that is where J^T r, summed from the residuals themselves, vanishes. Ceres' own damping,
/// the same for blocks, stops steps along directions that are left out here.
class compressed_cost final : public ceres::CostFunction {
 public:
  /// Points where `defined` is false, or anything is not finite, are rejected, with or without the Jacobian:
  /// Ceres writes to the standard error stream where one that it has accepted has none.
  compressed_cost(objective loss, std::function<bool(const Eigen::VectorXd&)> defined, int parameters)
      : loss_(std::move(loss)), defined_(std::move(defined)) {
    set_num_residuals(parameters + 1);
    mutable_parameter_block_sizes()->push_back(parameters);
  }

  /// Whether the point would not be rejected. Cost: that of Evaluate(), which then knows it.
  bool is_usable_at(const Eigen::VectorXd& theta) const {
    if (!defined_(theta)) return false;
    if (theta_.size() == 0 || theta != theta_) {
      at_theta_ = loss_(theta);
      theta_ = theta;
      compress();
    }
    return at_theta_.is_finite() && residuals_.allFinite() && jacobian_.allFinite();
  }

  /// What Ceres calls: false where the point is rejected. Cost: a pass with derivatives at a new point.
  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override {
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

 private:
  void compress() const {
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

  using rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  objective loss_;
  std::function<bool(const Eigen::VectorXd&)> defined_;
  // A step that is tried is nearly always taken, and then its derivatives are asked for: one pass gives all.
  mutable Eigen::VectorXd theta_;
  mutable squares at_theta_;
  mutable Eigen::VectorXd residuals_;
  mutable rows jacobian_;
};

}  // namespace nysalt
