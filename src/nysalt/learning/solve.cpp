// SPDX-License-Identifier: BSL-1.0
// From a problem of learning to a fit, judged.

#include <fmt/format.h>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "describe.hpp"
#include "nysalt/communicator.hpp"
#include "nysalt/learning/problem.hpp"
#include "nysalt/learning/search.hpp"
#include "nysalt/methods/phase_fitted.hpp"
#include "starts_of_fit.hpp"
#include "strongest_rival.hpp"

namespace nysalt {

using detail::contender;
using detail::fix;
using detail::is_better;
using detail::noise_of_difference;
using detail::objection;
using detail::options_within;
using detail::reason_to_withhold;
using detail::starts_of;
using detail::summarise_rival;
using detail::within;

namespace {

/// The frequency that was given, or that of the highest mode; where neither is, the highest that is met
/// often.
double frequency_to_fit(const learning_problem& problem) {
  if (problem.frequency_to_fit > 0.0) return problem.frequency_to_fit;
  return highest_frequency(problem.guard.frequencies(met::often));
}

/// The member of the family whose step is exact on an oscillator of the frequency to fit; nothing if there is
/// none.
std::optional<named_parameters> phase_fitted_member(const learning_problem& problem) {
  if (problem.family.letters.has_own_letters()) return std::nullopt;
  const double z = problem.step * frequency_to_fit(problem);
  if (!(z > 0.0) || !std::isfinite(z)) return std::nullopt;
  return phase_fitted_start(problem.family, z);
}

/// The best member of the family that this one contains: what is learned is no worse than what fewer
/// parameters give, which the first stages of a search among many lose sight of. Nothing where there is none.
std::optional<named_parameters> best_contained(search_task task, const learning_problem& problem) {
  const auto inner = problem.family.contained;
  if (!inner || task.stages.empty() || problem.options.start) return std::nullopt;
  const auto options = options_within(*inner, problem.options);
  if (!options) return std::nullopt;
  task.free.clear();
  for (Eigen::Index k = 0; k < inner->family.parameters(); ++k) {
    if (!options->fixed[static_cast<std::size_t>(k)]) task.free.push_back(k);
  }
  task.withstands = {};
  task.most_stable_member = {};
  constexpr int some_iterations = 20;  // as the search goes on from here
  task.max_iterations = some_iterations;
  const auto starts = starts_of(inner->family, *options, problem, task.free);
  const search_result found = search(within(*inner, task), starts);
  if (found.lost_after > 0) return std::nullopt;
  return named_parameters{"best of " + inner->family.name, inner->embed(found.best.theta)};
}

/// What a search by the one-step loss finds where the guard let no minimum of the loss itself through, if the
/// judge likes it better.
void try_one_step(search_task task, const std::vector<named_parameters>& starts, search_result& found) {
  const auto is_sound = [withstands = task.withstands](const candidate& one) {
    return one.admitted && (!withstands || withstands(one.theta));
  };
  const bool was_sound = is_sound(found.best);
  if (!task.one_step_loss || (was_sound && !found.best.is_held)) return;
  const objective whole = task.loss;
  task.loss = task.one_step_loss;
  task.stages = {{.loss = task.one_step_loss, .steps = 1}};
  task.one_step_loss = {};
  task.kept = {};
  const search_result other = search(task, starts);
  found.tried += other.tried;
  if (!is_sound(other.best) || (was_sound && !(other.best.judged < found.best.judged))) return;
  found.best = other.best;
  found.best.loss = whole(other.best.theta).value;
  found.best.is_held = true;  // no minimum of the loss itself
}

/// What came of one problem: a fit, or after how many steps no method followed the data.
struct attempt {
  std::optional<fit> found;
  int lost_after = 0;
  double seconds = 0.0;
};

/// The member at theta, for the step and the system of the data. A covariance loss asks no data, and has seen no
/// energies.
tabulated learned_method(const learning_problem& problem, const Eigen::VectorXd& theta, bool is_of_data) {
  const run_time_family& family = problem.family;
  method_validity validity = problem.validity;
  if (!is_of_data) validity.energies.reset();
  return {family.name,
          family.letters,
          family.coefficients(theta),
          {family.order, family.symmetric, family.requires_quadratic_kinetic},
          validity};
}

/// Searches from all starts, and judges the best.
attempt solve_as_it_is(const learning_problem& problem) {
  const auto began = std::chrono::steady_clock::now();
  const run_time_family& family = problem.family;
  const fit_options& options = problem.options;
  const shard& share = problem.held_out;
  detail::require_sound(family, options);
  std::vector<Eigen::Index> free;
  for (Eigen::Index k = 0; k < family.parameters(); ++k) {
    if (options.fixed.empty() || !options.fixed[static_cast<std::size_t>(k)]) free.push_back(k);
  }
  auto starts = starts_of(family, options, problem, free);
  const auto fitted = phase_fitted_member(problem);
  if (fitted && !options.start) {
    starts.push_back(*fitted);
    fix(options, starts.back().theta);
  }
  const bool has_data = problem.facts.is_of_data;
  const auto objection_of_guard = [&](const Eigen::VectorXd& theta, met which) {
    return problem.guard.objection(family.letters, family.coefficients(theta), problem.step, which);
  };
  const auto method_at = [&](const Eigen::VectorXd& theta) {
    return tabulated(family.name, family.letters, family.coefficients(theta), {1, false, false});
  };
  std::vector<std::pair<Eigen::VectorXd, judgement>> tried;
  const auto judged_at = [&](const Eigen::VectorXd& theta) {
    const auto known = std::ranges::find_if(tried, [&](const auto& one) { return one.first == theta; });
    if (known != tried.end()) return known->second;
    tried.emplace_back(theta, problem.judged(method_at(theta), problem.step));
    return tried.back().second;
  };
  const auto withstands = [&](const Eigen::VectorXd& theta) { return judged_at(theta).holds(); };
  search_task task{.family = &problem.family,
                   .loss = problem.loss,
                   .stages = problem.stages,
                   .one_step_loss = problem.one_step_before,
                   .judge = problem.judge,
                   .admits =
                       [&](const Eigen::VectorXd& theta) {
                         return !options.guarded || objection_of_guard(theta, met::often).empty();
                       },
                   .admits_at_edge =
                       [&](const Eigen::VectorXd& theta) {
                         return !options.guarded || objection_of_guard(theta, met::ever).empty();
                       },
                   .free = free,
                   .max_iterations = options.max_iterations};
  if (options.guarded) task.withstands = withstands;
  if (family.most_stable_member) {
    task.most_stable_member = named_parameters{"the most stable member", *family.most_stable_member};
    fix(options, task.most_stable_member->theta);
  }
  if (problem.shorter == nullptr) {
    for (auto& stage : task.stages) stage.lost_above = std::numeric_limits<double>::infinity();
  }
  const auto seconds = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  };
  const auto contained = best_contained(task, problem);
  if (contained) task.kept.push_back(*contained);
  search_result found = search(task, starts);
  if (found.lost_after > 0) return {{}, found.lost_after, seconds()};
  try_one_step(task, starts, found);

  const auto member_at = [&](const std::string& name, const Eigen::VectorXd& theta) {
    contender result{name, problem.held_out_losses(theta)};
    result.loss = share.sum(result.losses);
    result.theta = theta;
    result.objection = [&, theta] {
      const judgement found = judged_at(theta);
      return found.holds() ? std::string() : found.in_words();
    };
    return result;
  };
  contender chosen = member_at(found.best.from, found.best.theta);

  // What is handed out is not worse than a member of the family that was known before.
  std::vector<contender> members;
  const bool is_free = std::ssize(free) == family.parameters();
  if (is_free && has_data) {
    for (const auto& known : family.starts) {
      if (known.name != "further start") members.push_back(member_at(known.name, known.theta));
    }
    if (family.most_stable_member) members.push_back(member_at("equal steps", *family.most_stable_member));
    if (fitted) members.push_back(member_at(fitted->name, fitted->theta));
    if (contained) members.push_back(member_at(contained->name, contained->theta));
    std::ranges::stable_sort(members, {}, &contender::loss);
  }
  const bool has_settled = found.best.converged || found.best.in_valley || found.best.is_held;
  const bool is_chosen_sound = !options.guarded || chosen.withstands();
  for (const auto& member : members) {
    if (!options.guarded || !has_settled) break;
    const bool may_replace = is_better(member, chosen, share) || !is_chosen_sound;
    if (!may_replace || !member.withstands()) continue;
    if (!found.unguarded) found.unguarded = found.best;
    found.best = {.from = member.name,
                  .theta = member.theta,
                  .hessian = {},
                  .free = free,
                  .loss = task.loss(member.theta).value,
                  .is_held = true};
    chosen = member;
    break;
  }
  detail::require_same(share.ranks(), found.best.theta);
  const candidate& best = found.best;
  const Eigen::VectorXd& theta = best.theta;

  fit_summary summary = problem.facts;
  const auto at_start = problem.held_out_losses(starts.front().theta);
  summary.loss = best.loss;
  summary.held_out_loss = chosen.loss;
  summary.held_out_start_loss = share.sum(at_start);
  summary.held_out_noise = noise_of_difference(chosen.losses, at_start, share);
  summary.one_step_error = std::sqrt(problem.one_step_loss(theta));
  summary.trajectory_error = std::sqrt(problem.loss_at_end(theta));
  summary.starts_tried = found.tried;
  summary.from = best.from;
  summary.iterations = best.iterations;
  summary.is_in_valley = best.in_valley;
  summary.is_held_by_guard = best.is_held;
  summary.follows = !problem.follows || problem.follows(theta);
  summary.highest_frequency = problem.guard.highest_along();
  if (fitted) {
    summary.fitted_frequency = frequency_to_fit(problem);
    summary.source_of_frequency = options.frequency                ? "as given"
                                  : problem.frequency_to_fit > 0.0 ? "declared"
                                                                   : "the highest that the data meet often";
  }
  if (found.unguarded) {
    summary.unguarded = objection_of_guard(found.unguarded->theta, met::often);
    if (summary.unguarded.empty()) {
      const judgement of_unguarded = judged_at(found.unguarded->theta);
      if (!of_unguarded.holds()) summary.unguarded = of_unguarded.reason;
    }
    if (summary.unguarded.empty()) summary.unguarded = objection_of_guard(found.unguarded->theta, met::ever);
  }

  std::optional<spread_of_minimum> spread;
  if (best.is_held && has_data) summary.expected_excess = std::numeric_limits<double>::quiet_NaN();
  if (!best.is_held) {  // where it is, no minimum is near
    const curvature bend(best.hessian, best.free);
    if (has_data) {
      const auto scores = problem.scores(theta);
      const trajectory_scores none(std::vector<Eigen::VectorXd>{});
      spread = bend.spread(scores, problem.held_out_scores ? problem.held_out_scores(theta) : none);
      summary.expected_excess = bend.expected_excess(scores);
      summary.deciding_trajectories = bend.deciding_blocks(scores);
    }
    summary.condition = bend.condition();
    for (const auto& flat : bend.flat_directions()) {
      summary.flat_directions.emplace_back(flat.begin(), flat.end());
    }
  }
  summary.errors_withheld =
      has_data ? reason_to_withhold(problem, summary, best, free, spread) : std::string();
  for (Eigen::Index k = 0; k < theta.size(); ++k) {
    const bool is_estimated = has_data && std::ranges::find(free, k) != free.end();
    const bool varies = !best.is_held && std::ranges::find(best.free, k) != best.free.end();
    const bool is_flat = spread && std::isinf(spread->standard_errors[k]);
    const double error = !is_estimated ? 0.0
                         : !summary.errors_withheld.empty() && !is_flat
                             ? std::numeric_limits<double>::quiet_NaN()
                             : spread->standard_errors[k];
    summary.parameters.push_back(
        {family.parameter_names[static_cast<std::size_t>(k)], theta[k], error, varies});
  }
  for (const Eigen::Index k : free) {
    const bool is_held_there = std::find(best.free.begin(), best.free.end(), k) == best.free.end();
    if (is_held_there && std::abs(theta[k]) == farthest_parameter) summary.is_at_no_bound = false;
  }
  summary.judgement = judged_at(theta);
  const std::string instability = summary.judgement.holds() ? std::string() : summary.judgement.in_words();
  if (instability.empty()) {
    for (const auto& [low, high] :
         problem.guard.gaps(family.letters, family.coefficients(theta), problem.step)) {
      summary.gaps.push_back({low, high});
    }
  }

  if (contained) {  // what is learned, too, and no rival of it
    std::erase_if(members, [&](const contender& one) { return one.name == contained->name; });
  }
  if (has_data) summarise_rival(problem, chosen, std::move(members), summary);
  summary.reason = objection(summary, best.converged || best.in_valley || best.is_held, instability);
  summary.usable = summary.reason.empty();
  summary.learning_evaluations = problem.evaluations();
  summary.fit_seconds = seconds();
  return {.found = fit{theta, summary, learned_method(problem, theta, summary.is_of_data)},
          .seconds = summary.fit_seconds};
}

}  // namespace

/// Over fewer steps where the data cannot be followed over all. Throws std::invalid_argument for options
/// that the family cannot take. Cost: see learn().
fit solve(const learning_problem& problem) {
  const attempt first = solve_as_it_is(problem);
  const auto& found = first.found;
  if (found && (problem.shorter == nullptr || found->summary.follows)) return *found;
  const learning_problem* next = problem.shorter.get();
  const auto is_lost_too = [&] {
    return !next->stages.empty() && next->stages.back().steps >= first.lost_after;
  };
  while (!found && next->shorter != nullptr && is_lost_too()) next = next->shorter.get();
  fit other = solve(*next);
  if (found && found->summary.usable && !other.summary.usable) return *found;
  other.summary.fit_seconds += first.seconds;
  return other;
}

}  // namespace nysalt
