// SPDX-License-Identifier: BSL-1.0
// Who takes part, at which steps, and how far each errs.
#include "recommendation.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "catalogue.hpp"
#include "checks.hpp"
#include "known_word.hpp"
#include "learning.hpp"
#include "nysalt/analysis/tail.hpp"
#include "nysalt/detail/served_letters.hpp"
#include "seeds.hpp"
#include "stability_margin.hpp"

namespace nysalt::program {

recommendation::recommendation(std::unique_ptr<prepared_problem> system, recommendation_options asked,
                               common_settings common)
    : options_(std::move(asked)), common_(std::move(common)), system_(std::move(system)) {
  if (options_.observable.empty()) options_.observable = system_->default_observable();
  require_sound_command();
  plan_classical();
  plan_families();
  if (all_.empty()) refuse("no method suits: {}: {}", left_out_.front().first, left_out_.front().second);
}

void recommendation::learn_and_rank() {
  prepare_starts(*system_, common_, shown_);
  time_steps();
  if (options_.budget) {
    by_evaluations_ = {.unit = cost_unit::evaluations,
                       .budget = options_.budget,
                       .cost_ratio = 1.0,
                       .statistic = statistic(false),
                       .all = all_};
    run(*by_evaluations_);
    const candidate* best = by_evaluations_->best();
    by_seconds_ = best != nullptr ? at_equal_seconds(best->seconds_per_time, &*by_evaluations_)
                                  : contest(*by_evaluations_);
    run(*by_seconds_);
  } else if (options_.budget_seconds) {
    by_seconds_ = at_equal_seconds(*options_.budget_seconds, nullptr);
    run(*by_seconds_);
  } else {
    rank_at_one_error();
  }
  shown_.clear();
  warn_of_reference(asked());
}

/// Where a mean turns out to rest on few trajectories, all of it again by quantiles, from the optima found.
void recommendation::rank_at_one_error() {
  for (auto& contender : all_) prepare_search(contender);
  while (true) {
    find_steps(all_);
    constexpr double start_up = 1.01;  // a run of n steps may cost one evaluation more
    by_evaluations_ = {.unit = cost_unit::evaluations,
                       .budget = {},
                       .cost_ratio = grid_ratio * start_up,
                       .statistic = statistic(searches_by_quantiles_),
                       .all = all_};
    run(*by_evaluations_);
    by_seconds_ = by_evaluations_;
    by_seconds_->unit = cost_unit::seconds;
    double noise = 0.0;
    for (const bool learned : {true, false}) {
      if (const candidate* contender = by_evaluations_->best_of(learned)) noise += noise_of(*contender);
    }
    by_seconds_->cost_ratio = grid_ratio * (1.0 + noise);
    run(*by_seconds_);
    if (searches_by_quantiles_ || !(is_heavy(*by_evaluations_) || is_heavy(*by_seconds_))) return;
    searches_by_quantiles_ = true;
    for (auto& contender : all_) prepare_search(contender);
  }
}

/// What has no error yet is prepared and measured; then the best are looked at until they are confirmed.
void recommendation::run(contest& among) {
  std::vector<candidate*> fresh;
  for (auto& contender : among.all) {
    if (!contender.reason.empty() || !contender.error.scores.empty()) continue;
    const auto known = [&](const candidate& other) { return other.source.typed == contender.source.typed; };
    std::vector<double> from;
    if (by_evaluations_ && &among != &*by_evaluations_) {
      const auto other = std::ranges::find_if(by_evaluations_->all, known);
      const bool is_fit = other != by_evaluations_->all.end() && other->learned;
      if (is_fit && other->learned->fit.usable) from = theta_of(other->learned->fit);
    }
    if (!contender.method) prepare(contender, from);
    fresh.push_back(&contender);
  }
  measure_on_test(std::move(fresh));
  settle(among);
}

bool recommendation::is_heavy(const contest& among) const {
  return std::ranges::any_of(among.all, [](const candidate& contender) {
    return contender.stands() &&
           (contender.error.is_heavy || (contender.confirmed && contender.confirmed->is_heavy));
  });
}

void recommendation::settle(contest& among) {
  while (true) {
    // One statistic for all: else they could not be ranked.
    if (among.budget && !among.statistic.is_quantile && is_heavy(among)) among.statistic = statistic(true);
    if (options_.error) {
      for (auto& contender : among.all) {
        if (!contender.stands() || contender.confirmed) continue;
        if (!(among.statistic.lower_bound(contender.error.scores) > *options_.error)) continue;
        contender.reason = fmt::format("on fresh trajectories its error is {:.2e}, above {:g}",
                                       among.error_of(contender), *options_.error);
      }
    }
    among.rank();
    candidate* next = nullptr;
    for (auto& contender : among.all) {
      const bool is_best = &contender == among.best_of(true) || &contender == among.best_of(false);
      if (is_best && !contender.confirmed) next = &contender;
    }
    if (next == nullptr) break;
    confirm(among, *next);
  }
}

void recommendation::confirm(contest& among, candidate& contender) {
  std::string why = objection_to(contender);
  if (why.empty()) {
    candidate again = contender;
    measure_at(contender.step, {&again}, options_.trajectories, seed_for(role::confirmation, common_.seed));
    contender.confirmed = again.error;
    if (again.error.diverged > 0) {
      why = fmt::format("{} of {} fresh trajectories diverged", again.error.diverged, options_.trajectories);
    } else if (options_.error) {
      const double most = among.statistic.upper_bound(contender.confirmed->scores);
      if (!(most <= *options_.error))
        why = fmt::format("on fresh trajectories its error may be {:.2e}", most);
    }
  }
  if (why.empty()) return;
  if (options_.error) {
    step_down(contender);
    if (contender.reason.empty()) return;
    contender.reason += ": " + why;
  } else {
    contender.reason = why;
  }
}

/// As `run` would warn, and `stability` call the step not stable.
std::string recommendation::objection_to(const candidate& contender) const {
  const auto [found, is_new] = objections_.try_emplace({contender.source.typed, contender.step});
  if (!is_new) return found->second;
  const auto& name = contender.source.typed;
  if (const auto text = instability(name, *contender.method, *system_, contender.step)) {
    found->second = *text;
  } else if (const auto warning = stability_warning(name, *contender.method, *system_, contender.step,
                                                    seed_for(role::test, common_.seed))) {
    found->second = *warning;
  } else {
    const auto trial = try_step(*contender.method, *system_, contender.step,
                                seed_for(role::test, common_.seed), common_.threads);
    const std::string why = trial.objection();
    if (!why.empty()) found->second = fmt::format("at step {:g}: {}", contender.step, why);
  }
  return found->second;
}

error_statistic recommendation::statistic(bool by_quantiles) const {
  const bool is_root = options_.metric == "state" || options_.metric == "energy";
  return {is_root, by_quantiles};
}

void recommendation::require_sound_command() const {
  const int goals =
      options_.budget.has_value() + options_.budget_seconds.has_value() + options_.error.has_value();
  if (goals != 1) {
    refuse(
        "give one of --budget (force evaluations per unit time), --budget-seconds (per unit time of a "
        "trajectory) and --error (to stay below)");
  }
  if (options_.budget) require_positive("--budget", *options_.budget);
  if (options_.budget_seconds) require_positive("--budget-seconds", *options_.budget_seconds);
  if (options_.error) require_positive("--error", *options_.error);
  require_positive("--horizon", options_.horizon);
  require_at_least_one("--trajectories", options_.trajectories);
  require_sound(options_.learning, "--learn-");
  if (options_.error && options_.trajectories < 2) {
    refuse("--trajectories must be at least 2 with --error, got {}: one says nothing of others",
           options_.trajectories);
  }
  require_positive("--hmc-temperature", options_.hmc_temperature);
  placement_asked(options_.placement);
  if (options_.metric == "distribution" || options_.metric == "acf") {
    refuse(
        "recommend ranks by errors along trajectories: --metric {} is not among path, state, exchange, "
        "energy, acceptance",
        options_.metric);
  }
  const double nominal = 1e-3 * options_.horizon;
  system_->require_measure(
      metric(), plan_at(nominal, options_.trajectories, seed_for(role::test, common_.seed)), {}, 1);
}

/// Methods that repeat another at equal cost do not take part, nor letters O where there is no bath.
void recommendation::plan_classical() {
  for (const auto& name : method_names()) {
    if (name.ends_with("_2x")) continue;
    candidate contender{.source = find_method(name), .where = {}};
    const bool has_bath = system_->heat_bath().acts();
    if (contender.source.fixed) {
      const tabulated& method = *contender.source.fixed;
      if (!has_bath && method.letters().stochastic_letters > 0) continue;
      contender.order = method.order;
      contender.symmetric = method.symmetric;
      contender.rotates = has_rotation(method.letters());
    } else {
      contender.order = contender.source.adaptive->properties.order;
      contender.symmetric = contender.source.adaptive->properties.symmetric;
    }
    consider(std::move(contender));
  }
}

void recommendation::plan_families() {
  const auto names = options_.families.empty() ? family_names() : options_.families;
  const std::size_t before = all_.size();
  bool fixes = options_.learning.fix.empty();
  for (const auto& name : names) {
    const auto& family = family_named(name);
    if (!is_fixed_in(family)) continue;
    fixes = true;
    candidate contender{.source = find_method("learned:" + name), .where = {}};
    contender.order = family.order;
    contender.symmetric = family.symmetric;
    contender.rotates = has_rotation(family.letters);
    consider(std::move(contender));
  }
  if (!fixes)
    refuse("--fix {}: no family that is learned here has such parameters", listed(options_.learning.fix));
  const bool asked = !options_.families.empty() || !options_.learning.fix.empty();
  if (all_.size() == before && asked) {
    refuse("{}: {}", left_out_.back().first, left_out_.back().second);
  }
}

bool recommendation::is_fixed_in(const run_time_family& family) const {
  const auto& names = family.parameter_names;
  return std::ranges::all_of(options_.learning.fix, [&](const std::string& text) {
    return std::ranges::find(names, text.substr(0, text.find('='))) != names.end();
  });
}

/// Takes part, or is left out with the reason why.
void recommendation::consider(candidate contender) {
  const std::string name = contender.source.typed;
  charge(contender.source, *system_);
  const auto leave_out = [&](const std::string& why) { left_out_.emplace_back(name, why); };
  if ((options_.reversible || options_.metric == "acceptance") && !contender.symmetric) {
    return leave_out("it is not reversible");
  }
  try {
    const auto otherwise = placement_asked(options_.placement);
    contender.step =
        contender.source.evaluations_per_step / options_.budget.value_or(system_->fastest_rate());
    if (contender.is_learned()) contender.where = placement_in(contender.source, *system_, otherwise);
    if (options_.budget) {
      plan_at(contender.step, options_.trajectories, 0);
      if (!contender.is_learned()) {
        std::vector<std::string> ignored;  // what is not stable is seen to diverge
        contender.method =
            coefficients_at(contender.source, *system_, contender.step, false, otherwise, ignored);
      }
    } else if (contender.source.fixed) {
      system_->require_served(contender.source.fixed->letters());
    }
    if (contender.is_learned()) {
      system_->require_learnable(*contender.source.family, contender.where, options_.learning,
                                 contender.step);
    }
    all_.push_back(std::move(contender));
  } catch (const refusal& problem) {
    leave_out(problem.what());
  } catch (const std::invalid_argument& problem) {
    leave_out(problem.what());
  }
}

trajectories_plan recommendation::plan_at(double step, std::int64_t count, std::uint64_t seed) const {
  trajectories_plan plan{step, steps_within("--horizon", options_.horizon, step), count, seed,
                         common_.threads};
  if (!metric().is_along_paths()) return plan;
  plan.steps = steps_beyond("--horizon", options_.horizon, step);  // errors are means over all of the horizon
  plan.horizon = options_.horizon;
  return plan;
}

void recommendation::prepare(candidate& contender, const std::vector<double>& from, bool from_there_alone) {
  contender.reason.clear();
  const double samples = options_.horizon / contender.step;
  if (metric().is_along_paths() && samples < fewest_samples - 1e-9) {
    contender.reason = fmt::format(
        "--horizon {:g} holds {:.3g} of its steps of {:g}, fewer than the {:g} that a mean "
        "over time takes",
        options_.horizon, samples, contender.step, fewest_samples);
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
    plan.from = from;
    plan.from_there_alone = from_there_alone;
    contender.learned = learn_with(*system_, plan, shown_);
    contender.method = contender.learned->method;
    const fit_summary& fit = contender.learned->fit;
    if (!fit.usable) {
      contender.reason = "the fit is not usable: " + fit.reason;
    } else if (const auto known =
                   known_as(*contender.source.family, theta_of(fit), formulas_at(contender.step))) {
      contender.reason = "nothing was learned: it is " + *known;
    }
  } catch (const refusal& problem) {  // an adaptive method where it is not defined
    contender.reason = problem.what();
  }
}

/// Methods whose coefficients depend on the step.
std::vector<tabulated> recommendation::formulas_at(double step) const {
  std::vector<tabulated> all;
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

void recommendation::measure_on_test(std::vector<candidate*> all) {
  measure(all, options_.trajectories, seed_for(role::test, common_.seed));
  for (candidate* contender : all) {
    if (contender->method) contender->seconds_per_time = seconds_of_step(*contender) / contender->step;
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
  const auto take = [&](candidate& contender, estimate mean, std::vector<double> scores,
                        const auto& diverged_at) {
    contender.error = {mean, std::move(scores), false, std::ssize(diverged_at)};
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
      contender->evaluations_per_time = found.evaluations_per_time;
      take(*contender, {1.0 - found.probability.mean, found.probability.standard_error}, std::move(rejected),
           found.diverged_at);
    }
    return;
  }
  std::vector<tabulated> methods;
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
    contender.evaluations_per_time = method.evaluations_per_time;
    if (found.reference_error) contender.reference_error = found.reference_error->mean;
    contender.reference = found.reference;
    take(contender, method.error, std::move(scores), method.diverged_at);
  }
}

/// A reference that errs like the method says nothing of it.
void recommendation::warn_of_reference(const contest& among) {
  for (const auto& contender : among.all) {
    if (!contender.reference_error || !contender.stands() ||
        *contender.reference_error <= 0.1 * contender.error.mean.mean)
      continue;
    warnings_.push_back(
        fmt::format("the reference's own error {:.1e} is not ten times smaller than that of {}, "
                    "{:.1e}",
                    *contender.reference_error, contender.source.typed, contender.error.mean.mean));
  }
}

}  // namespace nysalt::program
