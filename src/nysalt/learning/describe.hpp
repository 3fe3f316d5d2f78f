// SPDX-License-Identifier: BSL-1.0
// When a fit is not to be trusted.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "curvature.hpp"
#include "nysalt/learning/fit_summary.hpp"
#include "nysalt/losses/squares.hpp"
#include "nysalt/shard.hpp"
#include "problem.hpp"

namespace nysalt::detail {

/// Standard error of sum_m (a_m - b_m) over independent trajectories m; infinite, as
/// nothing is known, if there is but one.
double noise_of_difference(const std::vector<double>& a, const std::vector<double>& b, const shard& share);

/// The numbers of the trajectories of all ranks. Collective.
std::vector<double> gathered(const std::vector<double>& numbers, const shard& share);

/// The statistic of Wilcoxon's signed-rank test of ln(b_m/a_m) over its standard deviation: normal(0, 1)
/// where a and b are equally good on each trajectory, positive where a is better [wilcoxon_1945]. Ties have
/// their mean rank, and equal losses do not count.
double signed_rank(const std::vector<double>& a, const std::vector<double>& b, const shard& share);

/// Whether a errs less than b on trajectories m that both share: the sum is smaller by more than rounding
/// (below 1e-24 errors are 1e-12 of an increment), and the difference of means or the signed ranks of the
/// ratios show it. So neither a few trajectories that decide a mean hide what is true of most, nor the many
/// hide what a few lose. Two standard errors of one criterion are a false alarm of 2.3 %; each of two
/// criteria may have half of that, which is 2.28 standard deviations (Bonferroni).
bool is_better(const std::vector<double>& a, const std::vector<double>& b, const shard& share);

/// Why a fit should not be used; empty if it may be. Settled: it converged, or is held by the guard.
std::string objection(const fit_summary& fit, bool settled, const std::string& instability);

}  // namespace nysalt::detail

// What is said of a fit: edges of the admitted region, and standard errors.

namespace nysalt {

/// From an admitted theta to one that no poll lowers: steps to either side along the eigenvectors of
/// Gauss-Newton's matrix, each as long as the loss at its bottom would ask for, then shorter. What is not
/// admitted is not taken, so that it slides along an edge. Cost: a pass with derivatives for each poll that
/// is admitted, `most_passes` at most.
Eigen::VectorXd descend_at_edge(const objective& loss, const theta_condition& admits, Eigen::VectorXd theta,
                                const std::vector<Eigen::Index>& free, int most_passes = 400);

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
