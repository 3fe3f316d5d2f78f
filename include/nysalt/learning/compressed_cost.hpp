// SPDX-License-Identifier: BSL-1.0
// A loss of any number of residuals as a Ceres cost with few.
#pragma once

#include <Eigen/Core>

#include <functional>

#include "nysalt/losses/squares.hpp"

namespace nysalt {

/// A least-squares cost of as many residuals as parameters, and one more: with J^T J = V D V^T the residuals
/// r' = (D^{-1/2} V^T J^T r, the root of what r^T r has more) and their Jacobian J' = (D^{1/2} V^T, 0) have
/// the loss, gradient and normal matrix of r and J, hence the same steps. Directions with an eigenvalue below
/// 1e-13 of the largest, where it is rounding, are left out: no residual changes along them. Where residuals
/// are small, twice J^T J is the Hessian, so that such a direction is one of the flat ones that `curvature`
/// finds, with a coarser sieve.
///
/// Normal equations square the condition number, which decides how well a step is known and not where the
/// search ends: that is where J^T r, summed from the residuals themselves, vanishes. Ceres' own damping,
/// the same for blocks, stops steps along directions that are left out here.
class compressed_cost {
 public:
  /// Points where `defined` is false, or anything is not finite, are rejected, with or without the Jacobian:
  /// Ceres writes to the standard error stream where one that it has accepted has none.
  compressed_cost(objective loss, std::function<bool(const Eigen::VectorXd&)> defined, int parameters);

  /// Whether the point would not be rejected. Cost: that of Evaluate(), which then knows it.
  bool is_usable_at(const Eigen::VectorXd& theta) const;

  /// Overrides ceres::CostFunction: false where the point is rejected. Cost: a pass with derivatives at a new
  /// point.
  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const;

 private:
  void compress() const;

  using rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  objective loss_;
  std::function<bool(const Eigen::VectorXd&)> defined_;
  Eigen::Index parameters_;
  // A step that is tried is nearly always taken, and then its derivatives are asked for: one pass gives all.
  mutable Eigen::VectorXd theta_;
  mutable squares at_theta_;
  mutable Eigen::VectorXd residuals_;
  mutable rows jacobian_;
};

}  // namespace nysalt
