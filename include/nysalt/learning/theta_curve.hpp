// SPDX-License-Identifier: BSL-1.0
// Parameters that were learned at several steps, and between them.
#pragma once

#include <Eigen/Core>

#include <vector>

namespace nysalt {

/// theta(step) through learned points: at a point what was learned there, between two of them the polynomial
/// through two on either side, and nothing beyond the first and the last.
class theta_curve {
 public:
  /// Through one theta for each step. Throws std::invalid_argument unless there is a theta for each step, all
  /// as long and finite, and the steps are positive and rise.
  theta_curve(std::vector<double> steps, std::vector<Eigen::VectorXd> thetas);

  const std::vector<double>& steps() const { return steps_; }             ///< step of each point, rising
  const std::vector<Eigen::VectorXd>& thetas() const { return thetas_; }  ///< learned theta at each step

  /// Whether a step lies between the first and the last, to 1e-9 relative, as steps are typed in decimals.
  bool covers(double step) const;

  /// Whether a step is one of the points, and not between.
  bool has(double step) const;

  /// theta at a step. Throws std::invalid_argument where it does not cover the step.
  Eigen::VectorXd at(double step) const;

 private:
  std::vector<double> steps_;
  std::vector<Eigen::VectorXd> thetas_;
};

}  // namespace nysalt
