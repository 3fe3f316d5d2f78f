// SPDX-License-Identifier: BSL-1.0
// What is said of a fit: edges, standard errors, summaries.

#include "describe.hpp"

#include <fmt/format.h>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <utility>

#include "nysalt/learning/fit_summary.hpp"
#include "nysalt/learning/learn_enough.hpp"
#include "nysalt/learning/reach.hpp"

namespace nysalt {

Eigen::VectorXd descend_at_edge(const objective& loss,
                                const std::function<bool(const Eigen::VectorXd&)>& admits,
                                Eigen::VectorXd theta, const std::vector<Eigen::Index>& free,
                                int most_passes) {
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

// A fit in words.

namespace nysalt {

namespace {

/// The standard error of a parameter in scientific notation with `digits` decimals, or why there is none.
std::string error_of(const fitted_parameter& p, const fit_summary& fit, int digits) {
  if (std::isinf(p.standard_error)) return "(not determined by the data)";
  if (std::isnan(p.standard_error)) return fit.is_held_by_guard ? "(held by the guard)" : "+- not known";
  return p.free ? fmt::format("+- {:.{}e}", p.standard_error, digits) : "(not free)";
}

}  // namespace

std::string fit_summary::verdict_in_words() const {
  switch (verdict()) {
    case nysalt::verdict::usable:
      return "usable";
    case nysalt::verdict::nothing_gained:
      return fmt::format("nothing gained over {}: {}{}", rival, what_to_take(),
                         failing_rival.name.empty() ? "" : "; " + of_failing_rival());
    case nysalt::verdict::not_usable:
      break;
  }
  return "NOT usable: " + reason;
}

std::string fit_summary::what_to_take() const {
  if (rival == "equal steps") return "take a method of one evaluation with smaller steps";
  if (rival == "phase_fitted") {
    return "the member of this family that follows from only the highest frequency is as good";
  }
  if (rival_step > 0.0) return fmt::format("take {} at step {:.4g}", rival, rival_step);
  return fmt::format("take {}", rival);
}

std::string fit_summary::of_failing_rival() const {
  if (failing_rival.name.empty()) return {};
  const auto& [name, of_name, times, why] = failing_rival;
  const std::string errs = times > 1.0 ? fmt::format("errs {:.2g} times less", times)
                                       : fmt::format("errs {:.2g} times as much", 1.0 / times);
  return fmt::format("{} at step {:.4g} {} in the median, and fails: {}", name, of_name, errs, why);
}

std::string fit_summary::uncertainty() const {
  if (std::isnan(expected_excess)) return "not known";
  return fmt::format(
      "adds {:.1e} to the loss on new data, {:.2g} % of it; it rests on {:.0f} trajectories{}",
      expected_excess, 100.0 * excess_share(), deciding_trajectories,
      is_decided_by_few() ? ", too few to rely on it: take more, or starts of less different energies" : "");
}

std::string fit_summary::following() const {
  if (follows_to_the_end()) return {};
  const std::string steps = fmt::format("{} step{}", loss_steps, loss_steps == 1 ? "" : "s");
  if (!follows) return fmt::format("its error exceeds a twentieth of the motion within {}", steps);
  return fmt::format("it follows trajectories for {}, not for {}", steps, trajectory_steps);
}

std::string fit_summary::brief() const {
  std::string text = fmt::format("{} at step {:g} for {}:", family, step, system);
  for (const auto& p : parameters) {
    text += fmt::format(" {} = {:.6f}", p.name, p.value);
    text += fmt::format(" {}", error_of(p, *this, 1));
  }
  text += fmt::format(", loss {:.3e}, held out {:.3e}{}, {}", loss, held_out_loss,
                      held_out_is_new ? "" : " (the same data)", verdict_in_words());
  if (usable && !follows_to_the_end()) text += "; but " + following();
  return text;
}

std::string fit_summary::full() const {
  std::string text = fmt::format("{} at step {} for {}\n", family, step, system);
  for (const auto& p : parameters) {
    text += fmt::format("  {:<22}{:.17g}  {}\n", p.name, p.value, error_of(p, *this, 2));
  }
  const auto line = [&](const char* what, const std::string& value) {
    text += fmt::format("  {:<22}{}\n", what, value);
  };
  line("usable", !usable ? "no: " + reason
                 : gains_nothing
                     ? fmt::format("yes, but nothing is gained over {}: {}", rival, what_to_take())
                     : "yes");
  if (!follows_to_the_end())
    line("trajectories", following() + "; take a smaller step to follow them longer");
  const std::string of_steps = is_of_data && 1 < loss_steps ? fmt::format(" over {} steps", loss_steps) : "";
  line("loss", is_of_data ? fmt::format("{:.6e} ({}{}) on {} pairs of {} trajectories", loss, loss_name,
                                        of_steps, samples, trajectories)
                          : fmt::format("{:.6e} ({})", loss, loss_name));
  line("held-out loss",
       fmt::format("{:.6e} on {} pairs; at the start {:.6e}{}", held_out_loss, held_out_samples,
                   held_out_start_loss, held_out_is_new ? "" : "; but these are the data learned from"));
  if (is_of_data && coordinates_used > 0) {
    line("per coordinate",
         fmt::format("{:.3g} root mean square on held-out data, {} to {:.3g} at the start",
                     std::sqrt(held_out_loss / static_cast<double>(coordinates_used)),
                     held_out_loss > held_out_start_loss ? "WORSE compared" : "compared",
                     std::sqrt(held_out_start_loss / static_cast<double>(coordinates_used))));
  }
  if (!rival.empty()) {
    line("best classical",
         fmt::format("{}{} of the same cost, held-out loss {:.6e} ({:.3g} times {}, +- {})", rival,
                     rival_step > 0.0 ? fmt::format(" at step {:.4g}", rival_step) : std::string(),
                     rival_loss, gain(),
                     loss_beside_rival == held_out_loss
                         ? std::string("this")
                         : fmt::format("{:.6e}, by times that both have", loss_beside_rival),
                     std::isfinite(rival_noise) ? fmt::format("{:.2g}", rival_noise / loss_beside_rival)
                                                : std::string("unknown")));
  }
  if (!errors_withheld.empty()) line("standard errors", "not known: " + errors_withheld);
  if (!failing_rival.name.empty()) line("fails its trial", of_failing_rival());
  if (is_of_data) line("uncertainty", uncertainty());
  line("search", fmt::format("{} starts; this is from '{}'{}", starts_tried, from,
                             is_held_by_guard ? ", held by the guard"
                             : is_in_valley   ? ", in a valley of parameters that do as well"
                                              : ""));
  line("stability", guard);
  line("judgement", judgement.in_words());
  line("trial", judgement.report());
  if (fitted_frequency > 0.0)
    line("phase-fitted", fmt::format("the frequency {:.6g}, {}", fitted_frequency, source_of_frequency));
  if (!unguarded.empty()) line("without the guard", unguarded);
  for (const auto& [low, high] : gaps) {
    line("gap",
         fmt::format("unstable for z = {:.4g} to {:.4g}, which the motion meets rarely or never", low, high));
  }
  if (!judgement.resonance.empty()) line("resonance", judgement.resonance);
  line("one-step error",
       fmt::format("{:.3e}, the reference's own {}", one_step_error,
                   reference_checked ? fmt::format("{:.3e}", reference_error) : "not measured"));
  line("trajectory error", fmt::format("{:.3e} at the end of held-out trajectories", trajectory_error));
  line("coordinates", coordinates);
  for (const auto& name : dropped) line("never moves", name + ", left out of the loss");
  line("condition", fmt::format("{:.3g}", condition));
  for (const auto& direction : flat_directions) {
    if (!std::isfinite(direction.front())) continue;  // of a Hessian that is 0
    std::string components;
    for (const double x : direction) components += fmt::format(" {:.4f}", x);
    line("flat direction", components);
  }
  line("iterations", fmt::format("{}", iterations));
  line("reference", reference);
  line("starts", fmt::format("{}, seed {}, held out {}", ensemble, seed, held_out_seed));
  line("force derivatives", derivatives);
  line("cost", fmt::format("{} force evaluations; data {:.3g} s, fit {:.3g} s", learning_evaluations,
                           data_seconds, fit_seconds));
  return text;
}

// Parameters between the steps that they were learned at.

namespace {
constexpr double same_step = 1e-9;  // relative
}  // namespace

theta_curve::theta_curve(std::vector<double> steps, std::vector<Eigen::VectorXd> thetas)
    : steps_(std::move(steps)), thetas_(std::move(thetas)) {
  bool sound = !steps_.empty() && steps_.size() == thetas_.size();
  for (std::size_t k = 0; sound && k < steps_.size(); ++k) {
    sound = std::isfinite(steps_[k]) &&
            (k == 0 ? steps_[k] > 0.0 : steps_[k - 1] * (1.0 + 2.0 * same_step) < steps_[k]) &&
            thetas_[k].allFinite() && thetas_[k].size() == thetas_[0].size();
  }
  if (sound) return;
  throw std::invalid_argument(
      "a curve of parameters must have rising steps, and as many finite parameters at each");
}

bool theta_curve::covers(double step) const {
  return steps_.front() * (1.0 - same_step) <= step && step <= steps_.back() * (1.0 + same_step);
}

bool theta_curve::has(double step) const {
  return std::any_of(steps_.begin(), steps_.end(),
                     [&](double s) { return std::abs(step - s) <= same_step * s; });
}

Eigen::VectorXd theta_curve::at(double step) const {
  if (!covers(step)) {
    throw std::invalid_argument(fmt::format("the step must be from {} to {}, the steps of learning, got {}",
                                            steps_.front(), steps_.back(), step));
  }
  for (std::size_t k = 0; k < steps_.size(); ++k) {
    if (std::abs(step - steps_[k]) <= same_step * steps_[k]) return thetas_[k];
  }
  const auto after =
      static_cast<std::size_t>(std::upper_bound(steps_.begin(), steps_.end(), step) - steps_.begin());
  const std::size_t count = std::min<std::size_t>(4, steps_.size());
  const std::size_t first = std::min(after < 2 ? 0 : after - 2, steps_.size() - count);
  Eigen::VectorXd result = Eigen::VectorXd::Zero(thetas_[0].size());
  for (std::size_t k = first; k < first + count; ++k) {  // Lagrange's form
    double weight = 1.0;
    for (std::size_t j = first; j < first + count; ++j) {
      if (j != k) weight *= (step - steps_[j]) / (steps_[k] - steps_[j]);
    }
    result += weight * thetas_[k];
  }
  return result;
}

// How many trajectories are enough.

std::string enough_course::report() const {
  const auto& [trajectories, share, deciding] = stops.back();
  if (is_reached) return fmt::format("{} trajectories are enough", trajectories);
  return fmt::format(
      "{} trajectories are not enough: the uncertainty of the parameters adds {:.2g} of the loss, and "
      "rests on "
      "{:.0f} of them",
      trajectories, share, deciding);
}

enough_course until_enough(std::int64_t first, const enough_options& options,
                           const std::function<fit_summary(std::int64_t trajectories)>& learn) {
  if (!(options.share > 0.0) || first < 2 || first > options.most) {
    throw std::invalid_argument(
        fmt::format("until_enough: share must be > 0 and trajectories a range from 2 or more, got a "
                    "share of {} and {} to {} trajectories",
                    options.share, first, options.most));
  }
  enough_course course;
  for (std::int64_t trajectories = first;; trajectories = std::min(2 * trajectories, options.most)) {
    const fit_summary fit = learn(trajectories);
    const double share = fit.excess_share();
    course.stops.push_back({trajectories, share, fit.deciding_trajectories});
    course.is_reached = share <= options.share && !fit.is_decided_by_few();
    if (course.is_reached || std::isnan(share) || trajectories == options.most) return course;
  }
}

}  // namespace nysalt
