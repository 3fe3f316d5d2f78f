// SPDX-License-Identifier: BSL-1.0
// From a problem of learning to a fit, judged.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "nysalt/learning/fit.hpp"
#include "nysalt/learning/objection.hpp"
#include "nysalt/learning/search.hpp"

namespace nysalt {

namespace detail {

/// Puts in the values of parameters that are not to be learned.
inline void fix(const fit_options& options, Eigen::VectorXd& theta) {
  for (std::size_t k = 0; k < options.fixed.size(); ++k) {
    if (options.fixed[k]) theta[static_cast<Eigen::Index>(k)] = *options.fixed[k];
  }
}

inline std::vector<named_parameters> starts_of(const run_time_family& family, const fit_options& options,
                                               const std::vector<Eigen::Index>& free) {
  std::vector<named_parameters> starts = family.starts;
  if (options.start) starts = {{"start", *options.start}};
  starts.insert(starts.end(), options.further_starts.begin(), options.further_starts.end());
  for (auto& start : starts) fix(options, start.theta);
  for (int n = 0; n < options.random_starts; ++n) {
    const auto number = static_cast<std::uint64_t>(n);
    starts.push_back({fmt::format("random {}", n + 1),
                      random_start(family, starts.front().theta, free, options.seed, number)});
  }
  return starts;
}

/// Ranks search each by itself with the same sums. They would not take the same steps if their processors'
/// libraries differed in a bit.
inline void require_same(const communicator& ranks, const Eigen::VectorXd& theta) {
  if (ranks.is_alone()) return;
  Eigen::VectorXd of_first = theta;
  ranks.broadcast(std::as_writable_bytes(std::span(of_first.data(), static_cast<std::size_t>(theta.size()))),
                  0);
  together(ranks, [&] {
    if (theta == of_first) return;
    throw std::runtime_error(
        fmt::format("learn: rank {} came to other parameters than rank 0: run all on processors of one kind",
                    ranks.rank()));
  });
}

inline void require_sound(const run_time_family& family, const fit_options& options) {
  if (options.max_iterations < 0 || options.random_starts < 0) {
    throw std::invalid_argument(
        fmt::format("learn: max_iterations and random_starts must not be negative, got {} and {}",
                    options.max_iterations, options.random_starts));
  }
  const auto count = static_cast<std::size_t>(family.parameters());
  if ((options.start && options.start->size() != family.parameters()) ||
      (!options.fixed.empty() && options.fixed.size() != count)) {
    throw std::invalid_argument(fmt::format(
        "learn: {} has {} parameters, start and fixed values must be as many", family.name, count));
  }
  for (const auto& start : options.further_starts) {
    if (start.theta.size() == family.parameters() && !start.theta.allFinite()) {
      throw std::invalid_argument(fmt::format("learn: the start '{}' is not finite", start.name));
    }
    if (start.theta.size() == family.parameters()) continue;
    throw std::invalid_argument(fmt::format("learn: the start '{}' has {} parameters, {} has {}", start.name,
                                            start.theta.size(), family.name, family.parameters()));
  }
  Eigen::VectorXd first = options.start.value_or(family.starts.front().theta);
  fix(options, first);
  require_in_range(family, first);
}

}  // namespace detail

/// Searches from all starts, and judges the best. Throws std::invalid_argument for options that the family
/// cannot take. Cost: see learn().
fit solve(const learning_problem& problem) {
  const auto began = std::chrono::steady_clock::now();
  const run_time_family& family = problem.family;
  const fit_options& options = problem.options;
  detail::require_sound(family, options);
  std::vector<Eigen::Index> free;
  for (Eigen::Index k = 0; k < family.parameters(); ++k) {
    if (options.fixed.empty() || !options.fixed[static_cast<std::size_t>(k)]) free.push_back(k);
  }
  const auto starts = detail::starts_of(family, options, free);
  const bool has_data = !problem.law;
  const auto objection_of_guard = [&](const Eigen::VectorXd& theta) {
    return problem.guard.objection(problem.family.letters, problem.family.coefficients(theta), problem.step);
  };
  search_task task{.family = &problem.family,
                   .loss = has_data ? problem.loss : objective_of(*problem.law, problem.family),
                   .judge = problem.judge,
                   .admits =
                       [&](const Eigen::VectorXd& theta) {
                         return !problem.options.guarded || objection_of_guard(theta).empty();
                       },
                   .free = free,
                   .max_iterations = options.max_iterations};
  if (family.refuge) {
    task.refuge = named_parameters{"refuge", *family.refuge};
    detail::fix(options, task.refuge->theta);
  }
  if (!has_data) {  // it is its own judge
    task.judge = [&](const Eigen::VectorXd& theta) { return task.loss(theta).value; };
  }
  const search_result found = search(task, starts);
  detail::require_same(problem.held_out.ranks(), found.best.theta);
  const candidate& best = found.best;
  const Eigen::VectorXd& theta = best.theta;

  fit_summary summary = problem.facts;
  const auto at_start = problem.held_out_losses(starts.front().theta);
  const auto at_end = problem.held_out_losses(theta);
  summary.loss = best.loss;
  summary.held_out_loss = problem.held_out.sum(at_end);
  summary.held_out_start_loss = problem.held_out.sum(at_start);
  summary.held_out_noise = detail::noise_of_difference(at_end, at_start, problem.held_out);
  summary.one_step_error = std::sqrt(problem.one_step_loss(theta));
  summary.trajectory_error = std::sqrt(problem.loss_at_end(theta));
  summary.starts_tried = found.tried;
  summary.from = best.from;
  summary.iterations = best.iterations;
  summary.is_in_valley = best.in_valley;
  summary.is_held_by_guard = best.is_held;
  if (found.unguarded) summary.unguarded = objection_of_guard(found.unguarded->theta);

  Eigen::VectorXd errors = Eigen::VectorXd::Zero(theta.size());
  if (best.is_held && has_data) summary.expected_excess = std::numeric_limits<double>::quiet_NaN();
  if (!best.is_held) {  // where it is, no minimum is near
    const curvature bend(best.hessian, best.free);
    if (has_data) {
      const auto scores = problem.scores(theta);
      errors = bend.standard_errors(scores);
      summary.expected_excess = bend.expected_excess(scores);
      summary.deciding_trajectories = bend.deciding_blocks(scores);
    }
    summary.condition = bend.condition();
    for (const auto& flat : bend.flat_directions()) {
      summary.flat_directions.emplace_back(flat.begin(), flat.end());
    }
  }
  for (Eigen::Index k = 0; k < theta.size(); ++k) {
    const bool is_free = !best.is_held && std::find(best.free.begin(), best.free.end(), k) != best.free.end();
    summary.parameters.push_back(
        {family.parameter_names[static_cast<std::size_t>(k)], theta[k], is_free ? errors[k] : 0.0, is_free});
  }
  for (const Eigen::Index k : free) {
    const bool is_held_there = std::find(best.free.begin(), best.free.end(), k) == best.free.end();
    if (is_held_there && std::abs(theta[k]) == farthest_parameter) summary.is_at_no_bound = false;
  }
  const std::string instability = objection_of_guard(theta);
  if (instability.empty()) {
    for (const auto& [low, high] :
         problem.guard.gaps(family.letters, family.coefficients(theta), problem.step)) {
      summary.gaps.push_back({low, high});
    }
  }
  summary.reason = detail::objection(summary, best.converged || best.in_valley || best.is_held, instability);
  summary.usable = summary.reason.empty();
  summary.learning_evaluations = problem.evaluations();
  summary.fit_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  return {theta, summary};
}

}  // namespace nysalt
