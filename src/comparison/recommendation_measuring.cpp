// SPDX-License-Identifier: BSL-1.0
// Errors of candidates at their steps.
#include <algorithm>

#include "catalogue.hpp"
#include "checks.hpp"
#include "known_word.hpp"
#include "learning.hpp"
#include "nysalt/analysis/statistics.hpp"
#include "recommendation.hpp"
#include "seeds.hpp"

namespace nysalt::program {

trajectories_plan recommendation::plan_at(double step, std::int64_t count, std::uint64_t seed) const {
  trajectories_plan plan{step, steps_within("horizon", options_.horizon, step), count, seed,
                         common_.execution.threads};
  if (!metric().is_along_paths()) return plan;
  plan.steps = steps_beyond("horizon", options_.horizon, step);  // errors are means over all of the horizon
  plan.horizon = options_.horizon;
  return plan;
}

void recommendation::prepare(candidate& contender, std::int64_t trajectories, const search_starts& starts) {
  contender.reason.clear();
  const double samples = options_.horizon / contender.step;
  if (metric().is_along_paths() && samples < fewest_samples - 1e-9) {
    contender.reason = fmt::format(
        "{} {:g} holds {:.3g} of its steps of {:g}, fewer than the {:g} that a mean over time takes",
        spelled("horizon"), options_.horizon, samples, contender.step, fewest_samples);
    return;
  }
  try {
    if (!contender.is_learned()) {
      std::vector<std::string> ignored;
      contender.method = coefficients_at(contender.source, *system_, contender.step, false,
                                         placement_asked(options_.placement), ignored);
      return;
    }
    learn_plan plan =
        plan_for(*contender.source.family, contender.where, contender.step, options_.learning, common_);
    plan.how.trajectories = std::min(trajectories, plan.how.trajectories);
    plan.from = starts.known;
    plan.only_from_there = starts.which == start_set::known;
    plan.contained = starts.contained;
    plan.goes_on = plan.how.trajectories < options_.learning.trajectories;
    if (starts.which == start_set::few) plan.how.effort = "quick";
    contender.learned = learn_with(*system_, plan, shown_);
    contender.learned_from = plan.how.trajectories;
    contender.is_searched_for |= starts.which == start_set::all;
    contender.method = contender.learned->method;
    const fit_summary& fit = contender.learned->fit;
    if (!fit.usable) {
      contender.reason = "the fit is not usable: " + fit.reason;
    } else if (const auto known = known_as(*contender.source.family, theta_of(fit),
                                           formulas_at(contender.step), system_->letters())) {
      contender.reason = "nothing was learned: it is " + *known;
    }
  } catch (const refusal& problem) {  // an adaptive method where it is not defined
    contender.reason = problem.what();
  }
}

/// Methods whose coefficients depend on the step.
std::vector<method> recommendation::formulas_at(double step) const {
  std::vector<method> all;
  if (system_->heat_bath().acts()) return all;
  for (const auto& contender : all_) {
    if (contender.source.adaptive == nullptr) continue;
    try {
      std::vector<std::string> ignored;
      const auto method = coefficients_at(contender.source, *system_, step, false, {}, ignored);
      all.emplace_back(contender.source.typed, method.letters(), method.coefficients(), method);
    } catch (const refusal&) {  // where the method is not defined
    }
  }
  return all;
}

void recommendation::measure_on_test(const std::vector<candidate*>& all, std::int64_t count) {
  measure(all, count, seed_for(role::test, common_.seed));
  for (candidate* contender : all) {
    if (!contender->method) continue;
    contender->seconds_per_time =
        seconds_of_step(*contender) / contender->step + seconds_of_processing(*contender);
  }
}

void recommendation::measure(const std::vector<candidate*>& all, std::int64_t count, std::uint64_t seed) {
  std::map<double, std::vector<candidate*>> by_step;  // candidates at one step share the reference
  for (candidate* contender : all) {
    if (contender->reason.empty()) by_step[contender->step].push_back(contender);
  }
  for (const auto& [step, group] : by_step) measure_at(step, group, count, seed);
}

void recommendation::measure_at(double step, const std::vector<candidate*>& group, std::int64_t count,
                                std::uint64_t seed) {
  const trajectories_plan plan = plan_at(step, count, seed);
  shown_.part(fmt::format("comparing {} at step {:g}", group.size() == 1 ? "one" : "some", step));
  const auto of_further_observations =
      [&](const candidate& contender) {  // the first one is counted with the run
        return static_cast<double>((options_.looks - 1) * contender.source.evaluations_to_observe) /
               options_.horizon;
      };
  const auto take = [&](candidate& contender, estimate mean, std::vector<double> scores,
                        const auto& diverged_at) {
    contender.error = {mean, std::move(scores), false, std::ssize(diverged_at), count};
    contender.error.is_heavy = tail_of(contender.error.scores).is_heavy();
    if (contender.error.diverged < count) return;
    const auto earliest = std::ranges::min(diverged_at, {}, &diverged_trajectory::step);
    contender.reason = fmt::format("every trajectory diverged, the first of them at step {}", earliest.step);
  };
  if (options_.metric == "acceptance") {
    for (candidate* contender : group) {
      const auto found = system_->acceptance(*contender->method, plan, options_.hmc_temperature, {});
      std::vector<double> rejected;
      for (const double a : found.of_each) rejected.push_back(1.0 - a);
      contender->evaluations_per_time = found.evaluations_per_time + of_further_observations(*contender);
      take(*contender, {1.0 - found.probability.mean, found.probability.standard_error}, std::move(rejected),
           found.diverged_at);
    }
    return;
  }
  std::vector<method> methods;
  for (const candidate* contender : group) methods.push_back(*contender->method);
  const errors_plan asked{
      .trajectories = plan, .metrics = {metric()}, .fine_step = system_->fine_step_for_ranking(step)};
  const auto found = system_->errors(methods, asked, shown_.counter(plan.count)).front();
  const bool is_root = statistic(false).is_root;
  for (std::size_t k = 0; k < group.size(); ++k) {
    candidate& contender = *group[k];
    const method_error& method = found.methods[k];
    std::vector<double> scores = method.own;
    if (is_root) {
      for (double& x : scores) x *= x;
    }
    contender.evaluations_per_time = method.evaluations_per_time + of_further_observations(contender);
    if (found.reference_error) contender.reference_error = found.reference_error->mean;
    contender.reference = found.reference;
    take(contender, method.error, std::move(scores), method.diverged_at);
  }
}

/// A reference that errs like the method says nothing of it; but where errors are to be below a bound, it may
/// err by a part of that.
void recommendation::warn_of_reference(const contest& among) {
  for (const auto& contender : among.all) {
    if (!contender.reference_error || !contender.is_eligible()) continue;
    const double allowed = std::max(contender.error.mean.mean, options_.error.value_or(0.0));
    if (*contender.reference_error <= 0.1 * allowed) continue;
    warnings_.push_back(
        fmt::format("the reference's own error {:.1e} is not ten times smaller than that of {}, "
                    "{:.1e}",
                    *contender.reference_error, contender.source.typed, contender.error.mean.mean));
  }
}

}  // namespace nysalt::program
