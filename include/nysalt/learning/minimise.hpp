// SPDX-License-Identifier: BSL-1.0
// From a start to the minimum of a loss: Ceres, then Newton's method for the last digits.
#pragma once

#include <Eigen/Core>

#include <functional>
#include <utility>
#include <vector>

#include "nysalt/losses/squares.hpp"

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

/// Ceres from theta, which becomes where it ends; parameters that are not free stay. The loss is flat along
/// a valley, on which Gauss-Newton steps are short: so the search does not end on small changes of the loss,
/// but on small steps. Where it does not end so, the last quarter of the iterations detects a valley. A
/// search that may climb takes up to five steps on which the loss grows, by which it crosses the bends of a
/// narrow valley; it ends at the least loss that it met.
void descend(ceres::Problem& problem, const std::vector<Eigen::Index>& free, int max_iterations,
             minimum& found, double function_tolerance = 0.0, bool may_climb = false);

/// Newton steps with the Hessian of where they begin, until rounding is reached; then it is that of the end,
/// to a part in a million.
void polish(const objective& loss, const std::function<bool(const Eigen::VectorXd&)>& defined,
            const std::vector<Eigen::Index>& free, minimum& found);

}  // namespace detail

/// Near a minimum, and the loss there: a few steps, until they lower the loss by less than a hundredth. From
/// a start that is not defined, or whose loss is not finite, it goes nowhere, and the loss is infinite. It
/// may climb as descend() may.
std::pair<Eigen::VectorXd, double> descend_roughly(const objective& loss,
                                                   const std::function<bool(const Eigen::VectorXd&)>& defined,
                                                   const Eigen::VectorXd& start,
                                                   const std::vector<Eigen::Index>& free,
                                                   bool may_climb = false);

/// Minimises over the free parameters. Converged: another Newton step would lower the loss by less than 1e-6
/// of itself. From a start that is not defined, or whose loss is not finite, it goes nowhere, and the loss is
/// infinite: Ceres would say so on the standard error stream.
minimum minimise(const objective& loss, const std::function<bool(const Eigen::VectorXd&)>& defined,
                 const Eigen::VectorXd& start, const std::vector<Eigen::Index>& free, int max_iterations);

}  // namespace nysalt
