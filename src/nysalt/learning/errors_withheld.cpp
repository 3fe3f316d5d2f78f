// SPDX-License-Identifier: BSL-1.0
// When the scatter of theta over other data is not known, and why.
#include "errors_withheld.hpp"

#include <fmt/format.h>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace nysalt::detail {

namespace {

/// An error that is printed is to be right to a factor of 1.4.
constexpr double factor = 1.4;

/// Of n deciding trajectories a standard error has the relative error 1/(2 sqrt n), and three of these are to
/// be less than the factor: n > (3/(2 ln 1.4))^2 = 19.9.
constexpr double fewest_that_decide = 20.0;

/// A standard error goes with the inverse of the curvature, which may be too large by this part of it.
constexpr double largest_error_of_hessian = 1.0 - 1.0 / factor;

}  // namespace

double relative_error_of_hessian(const learning_problem& problem, const candidate& best) {
  constexpr double millionth = 1e-6;
  const Eigen::MatrixXd inverse = best.hessian(best.free, best.free).inverse();
  std::vector<Eigen::MatrixXd> of_each;
  shard share(0);
  for (std::size_t k = 0; k < best.free.size(); ++k) {
    const Eigen::Index parameter = best.free[k];
    const double s = std::sqrt(2.0 * millionth * best.loss / best.hessian(parameter, parameter));
    Eigen::VectorXd ahead = best.theta;
    Eigen::VectorXd behind = best.theta;
    ahead[parameter] += s;
    behind[parameter] -= s;
    const trajectory_scores there = problem.scores(ahead);
    const trajectory_scores back = problem.scores(behind);
    share = there.share;
    const auto count = static_cast<Eigen::Index>(best.free.size());
    of_each.resize(there.of_each.size(), Eigen::MatrixXd::Zero(count, count));
    for (std::size_t m = 0; m < of_each.size(); ++m) {
      const Eigen::VectorXd change = there.of_each[m] - back.of_each[m];
      of_each[m].col(static_cast<Eigen::Index>(k)) =
          change(best.free) / (ahead[parameter] - behind[parameter]);
    }
  }
  std::vector<double> squares;
  for (const Eigen::MatrixXd& one : of_each) {
    const Eigen::MatrixXd relative = inverse * (0.5 * (one + one.transpose()));
    squares.push_back((relative * relative).trace());
  }
  const double expected = static_cast<double>(best.free.size()) / static_cast<double>(share.total());
  return std::sqrt(std::max(share.sum(squares) - expected, 0.0));
}

std::string reason_to_withhold(const learning_problem& problem, const fit_summary& fit, const candidate& best,
                               const std::vector<Eigen::Index>& free,
                               const std::optional<spread_of_minimum>& spread) {
  if (free.empty()) return {};  // nothing is estimated
  if (best.is_held) return "the guard holds the parameters where the loss has no minimum";
  const bool is_rounding = fit.loss <= 1e-24;  // of errors of 1e-12 of an increment
  if (is_rounding) return {};
  if (best.in_valley) return "the search was given up in a valley, before its lowest point";
  if (!best.converged) return "the search did not converge";
  if (best.free.size() < free.size()) {
    return "a parameter is at the end of its range, where its distribution is one-sided";
  }
  if (fit.loss_steps < fit.trajectory_steps) {
    return fmt::format("the {} step{} of the loss were chosen by the same data", fit.loss_steps,
                       fit.loss_steps == 1 ? "" : "s");
  }
  if (fit.trajectories < 2) return "one trajectory has no scatter";
  if (!spread) return {};
  if (!spread->standard_errors.allFinite())
    return "the loss is flat along a direction, which no data determine";
  double fewest = spread->deciding[free.front()];
  for (const Eigen::Index k : free) fewest = std::min(fewest, spread->deciding[k]);
  if (!(fewest >= fewest_that_decide)) {
    return fmt::format(
        "they rest on {:.0f} of the trajectories, and fewer than {:.0f} show too small a scatter; take more, "
        "or "
        "starts of less different energies",
        std::floor(fewest), fewest_that_decide);
  }
  const double error = relative_error_of_hessian(problem, best);
  if (error <= largest_error_of_hessian) return {};
  return fmt::format(
      "single trajectories make the loss's curvature, whose own error is {:.2g} of it; take more "
      "trajectories",
      error);
}

}  // namespace nysalt::detail
