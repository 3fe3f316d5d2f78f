// SPDX-License-Identifier: BSL-1.0
// Objections to a fit: edges of the admitted region, standard errors that are withheld.

#include "describe.hpp"

#include <fmt/format.h>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "nysalt/losses/loss_choice.hpp"

// When a fit is not to be trusted, in words.

namespace nysalt::detail {

double noise_of_difference(const std::vector<double>& a, const std::vector<double>& b, const shard& share) {
  const auto count = static_cast<double>(share.total());
  if (share.total() < 2) return std::numeric_limits<double>::infinity();
  std::vector<double> terms;
  for (std::size_t m = 0; m < a.size(); ++m) terms.push_back(a[m] - b[m]);
  const double mean = share.sum(terms) / count;
  for (double& term : terms) term = (term - mean) * (term - mean);
  return std::sqrt(share.sum(terms) * count / (count - 1.0));
}

std::vector<double> gathered(const std::vector<double>& numbers, const shard& share) {
  std::vector<double> all(static_cast<std::size_t>(share.total()));
  std::ranges::copy(numbers, all.begin() + share.first());
  share.gather(all);
  return all;
}

double signed_rank(const std::vector<double>& a, const std::vector<double>& b, const shard& share) {
  const std::vector<double> of_a = gathered(a, share);
  const std::vector<double> of_b = gathered(b, share);
  std::vector<double> gains;  // ln(b/a)
  for (std::size_t m = 0; m < of_a.size(); ++m) {
    const double gain = std::log(of_b[m] / of_a[m]);
    constexpr double rounding = 1e-9;
    if (std::abs(gain) > rounding) gains.push_back(gain);  // nor NaN, where both are 0
  }
  std::ranges::sort(gains, {}, [](double x) { return std::abs(x); });
  const auto n = static_cast<double>(gains.size());
  if (gains.empty()) return 0.0;
  double sum = 0.0;  // of the ranks where a is better
  double variance = n * (n + 1.0) * (2.0 * n + 1.0) / 24.0;
  for (auto first = gains.begin(); first != gains.end();) {
    const auto last =
        std::find_if(first, gains.end(), [size = std::abs(*first)](double x) { return std::abs(x) != size; });
    const auto ties = static_cast<double>(last - first);
    const double rank = static_cast<double>(first - gains.begin()) + (ties + 1.0) / 2.0;
    sum += rank * static_cast<double>(std::count_if(first, last, [](double x) { return x > 0.0; }));
    variance -= (ties * ties * ties - ties) / 48.0;
    first = last;
  }
  return (sum - n * (n + 1.0) / 4.0) / std::sqrt(variance);
}

bool is_better(const std::vector<double>& a, const std::vector<double>& b, const shard& share) {
  constexpr double of_two = 2.28;  // standard deviations that a normal variable exceeds in 1.1 % of all cases
  const double loss = share.sum(a);
  const double other = share.sum(b);
  if (!(other > 1e-24 && loss < other * (1.0 - 1e-9))) return false;
  return loss < other - of_two * noise_of_difference(a, b, share) || signed_rank(a, b, share) > of_two;
}

std::string objection(const fit_summary& fit, bool settled, const std::string& instability) {
  if (!settled) return instability.empty() ? "the search did not converge" : instability;
  // Sigma is the mean square increment, so to stay where one is has the loss 1 in every coordinate. Proposals
  // need not be near the flow: a step of theirs may turn by more than half a period.
  const auto minimised = find_loss(fit.loss_name);
  const bool is_of_proposals = minimised && minimised->kind->is_of_proposals;
  const double one_step_loss = fit.one_step_error * fit.one_step_error;
  if (!is_of_proposals && !(one_step_loss < static_cast<double>(fit.coordinates_used))) {
    return fmt::format("its held-out one-step loss {:.2e} is no better than that of not moving at all",
                       one_step_loss);
  }
  if (!instability.empty()) return instability;
  if (!fit.is_at_no_bound)
    return "a parameter ran away to the end of its range: the data do not determine it";
  if (!fit.is_of_data) return {};
  // Worse by more than chance: a search may begin so near to the optimum, as for systems that are not stiff,
  // that other data prefer now the one and now the other. Half as much again is more than chance, for any
  // noise that a few trajectories show. Equal to rounding is no objection either.
  const double chance =
      std::min(3.0 * fit.held_out_noise, 0.5 * fit.held_out_start_loss) + 1e-9 * fit.held_out_start_loss;
  // Else the guard has objections to the start, or trajectories from there diverge.
  const bool may_begin_there = !fit.is_held_by_guard && std::isfinite(fit.held_out_start_loss);
  if (may_begin_there &&
      !(fit.held_out_loss <= fit.held_out_start_loss + chance || fit.held_out_loss <= 1e-24)) {
    return "on held-out data it is worse than the parameters that the search began with";
  }
  // A tenth would be too much: what is learned is a small correction, and the reference's error adds to it
  // like a bias, however many the data.
  if (fit.reference_checked && !(fit.reference_error <= 0.01 * fit.one_step_error)) {
    return fmt::format("the reference's own error {:.2e} is not small against the one-step error {:.2e}",
                       fit.reference_error, fit.one_step_error);
  }
  return {};
}

}  // namespace nysalt::detail

// Polls along the axes of Gauss-Newton's matrix.

namespace nysalt {

Eigen::VectorXd descend_at_edge(const objective& loss, const theta_condition& admits, Eigen::VectorXd theta,
                                const std::vector<Eigen::Index>& free, int most_passes) {
  constexpr double longest = 0.3;  // coefficients are of order one
  constexpr double shortest = 1e-3;
  if (free.empty()) return theta;
  squares here = loss(theta);
  int passes = 1;
  double length = 1.0;
  while (length > shortest && passes < most_passes && here.is_finite() && here.value > 0.0) {
    const Eigen::MatrixXd of_free = here.normal_matrix(free, free);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> axes(of_free);
    const double least = 1e-12 * axes.eigenvalues().maxCoeff();
    bool has_moved = false;
    for (Eigen::Index k = 0; k < axes.eigenvalues().size() && passes < most_passes; ++k) {
      const double reach = std::sqrt(here.value / std::max(axes.eigenvalues()[k], least));
      const bool is_uphill = axes.eigenvectors().col(k).dot(here.half_gradient(free)) > 0.0;
      for (const double sign : {is_uphill ? -1.0 : 1.0, is_uphill ? 1.0 : -1.0}) {
        Eigen::VectorXd next = theta;
        next(free) += sign * std::min(length * reach, longest) * axes.eigenvectors().col(k);
        if (!admits(next)) continue;
        const squares there = loss(next);
        ++passes;
        if (!(there.value < here.value)) continue;
        theta = next;
        here = there;
        has_moved = true;
        break;
      }
    }
    length = has_moved ? std::min(1.0, 1.5 * length) : 0.5 * length;
  }
  return theta;
}

}  // namespace nysalt

// When the scatter of theta over other data is not known, and why.

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
