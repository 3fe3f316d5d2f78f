// SPDX-License-Identifier: BSL-1.0
// What is said of a fit: edges of the admitted region, and standard errors.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "nysalt/learning/curvature.hpp"
#include "nysalt/learning/problem.hpp"
#include "nysalt/losses/squares.hpp"

namespace nysalt {

/// From an admitted theta to one that no poll lowers: steps to either side along the eigenvectors of
/// Gauss-Newton's matrix, each as long as the loss at its bottom would ask for, then shorter. What is not
/// admitted is not taken, so that it slides along an edge. Cost: a pass with derivatives for each poll that
/// is admitted, `most_passes` at most.
Eigen::VectorXd descend_at_edge(const objective& loss,
                                const std::function<bool(const Eigen::VectorXd&)>& admits,
                                Eigen::VectorXd theta, const std::vector<Eigen::Index>& free,
                                int most_passes = 400);

}  // namespace nysalt

namespace nysalt::detail {

/// The relative error of a Hessian H = sum_b H_b that is a sum over trajectories: the root of the expected
/// tr((H^-1 dH)^2), which bounds that of every curvature. It is that of a sample of B, sum_b tr((H^-1 H_b)^2)
/// - P/B, P the number of free parameters. The H_b are differences of scores, over a step that changes the
/// loss by a millionth. Cost: two passes with derivatives for each free parameter. Collective.
double relative_error_of_hessian(const learning_problem& problem, const candidate& best);

/// Reason why the standard errors of a fit of data are not known; empty: they are. `free` numbers the
/// parameters that the user left free; there is a spread where the fit is a minimum. Collective.
std::string reason_to_withhold(const learning_problem& problem, const fit_summary& fit, const candidate& best,
                               const std::vector<Eigen::Index>& free,
                               const std::optional<spread_of_minimum>& spread);

}  // namespace nysalt::detail
