// SPDX-License-Identifier: BSL-1.0
// A loss of any number of residuals as a Ceres cost with few.
#pragma once

#include <ceres/cost_function.h>
#include <Eigen/Core>
#include <functional>
#include <utility>
#include <vector>

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
class compressed_cost final : public ceres::CostFunction {
 public:
  /// Points where `defined` is false, or anything is not finite, are rejected, with or without the Jacobian:
  /// Ceres writes to the standard error stream where one that it has accepted has none.
  compressed_cost(objective loss, theta_condition defined, int parameters);

  /// Whether the point would not be rejected. Cost: that of Evaluate(), which then knows it.
  bool is_usable_at(const Eigen::VectorXd& theta) const;

  /// Overrides ceres::CostFunction: false where the point is rejected. Cost: a pass with derivatives at a new
  /// point.
  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override;

 private:
  void compress() const;

  using rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  objective loss_;
  theta_condition defined_;
  // A step that is tried is nearly always taken, and then its derivatives are asked for: one pass gives all.
  mutable Eigen::VectorXd theta_;
  mutable squares at_theta_;
  mutable Eigen::VectorXd residuals_;
  mutable rows jacobian_;
};

}  // namespace nysalt

// From a start to the minimum of a loss: Ceres, then Newton's method for the last digits.

namespace ceres {
class Problem;
}  // namespace ceres

namespace nysalt {

/// End point of a search.
struct minimum {
  Eigen::VectorXd theta;      ///< all parameters, those that are not free too
  double loss = 0.0;          ///< the loss at theta
  Eigen::MatrixXd hessian{};  ///< hessian of the loss at theta, by all parameters
  int iterations = 0;         ///< iterations of Ceres and of Newton's method together
  bool converged = false;     ///< another Newton step would lower the loss by less than 1e-6 of itself
  bool has_ended = false;     ///< whether Ceres ended by itself, and was not cut short
  bool in_valley = false;     ///< whether the search ended in a flat valley: not converged, but further
                              ///< iterations hardly lower the loss
};

namespace detail {

/// When a descent ends, and whether it may climb: it then takes up to five steps on which the loss grows, by
/// which it crosses the bends of a narrow valley, and ends at the least loss that it met.
struct descent {
  int max_iterations;
  double function_tolerance = 0.0;
  bool may_climb = false;
};

/// Ceres from theta, which becomes where it ends; parameters that are not free stay. The loss is flat along
/// a valley, on which Gauss-Newton steps are short: so the search does not end on small changes of the loss,
/// but on small steps. Where it does not end so, the last quarter of the iterations detects a valley.
void descend(ceres::Problem& problem, const std::vector<Eigen::Index>& free, const descent& how,
             minimum& found);

/// Newton steps with the Hessian of where they begin, until rounding is reached; then it is that of the end,
/// to a part in a million.
void polish(const objective& loss, const theta_condition& defined, const std::vector<Eigen::Index>& free,
            minimum& found);

}  // namespace detail

/// Near a minimum, and the loss there: a few steps, until they lower the loss by less than a hundredth. From
/// a start that is not defined, or whose loss is not finite, it goes nowhere, and the loss is infinite. It
/// may climb as descend() may.
std::pair<Eigen::VectorXd, double> descend_roughly(const objective& loss, const theta_condition& defined,
                                                   const Eigen::VectorXd& start,
                                                   const std::vector<Eigen::Index>& free,
                                                   bool may_climb = false);

/// Minimises over the free parameters. Converged: another Newton step would lower the loss by less than 1e-6
/// of itself. From a start that is not defined, or whose loss is not finite, it goes nowhere, and the loss is
/// infinite: Ceres would say so on the standard error stream.
minimum minimise(const objective& loss, const theta_condition& defined, const Eigen::VectorXd& start,
                 const std::vector<Eigen::Index>& free, int max_iterations);

}  // namespace nysalt
