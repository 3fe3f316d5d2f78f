// SPDX-License-Identifier: BSL-1.0
// Who takes part, at which steps, and how far each errs.
#include "recommendation.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "catalogue.hpp"
#include "checks.hpp"
#include "learning.hpp"
#include "nysalt/served_letters.hpp"
#include "seconds.hpp"
#include "seeds.hpp"

namespace nysalt::program {

recommendation::recommendation(const recommend_command& command, const common_settings& common)
    : command_(command), common_(common), system_(make_system(command.system)) {
  if (command_.observable.empty()) command_.observable = system_->default_observable();
  require_sound_command();
  plan_classical();
  plan_families();
  if (all_.empty()) refuse("no method suits: {}: {}", left_out_.front().first, left_out_.front().second);
}

void recommendation::learn_and_rank() {
  prepare_starts(*system_, common_, shown_);
  if (command_.budget) {
    for (auto& its : all_) prepare(its);
  } else {
    find_steps();
  }
  std::vector<candidate*> everyone;
  for (auto& its : all_) everyone.push_back(&its);
  measure(everyone, command_.trajectories, seed_for(role::test, common_.seed));
  measure_seconds();
  shown_.clear();
  rank();
  warn_of_reference();
}

void recommendation::require_sound_command() const {
  if (command_.budget.has_value() == command_.error.has_value()) {
    refuse("give one of --budget (force evaluations per unit time) and --error (to stay below)");
  }
  if (command_.budget) require_positive("--budget", *command_.budget);
  if (command_.error) require_positive("--error", *command_.error);
  require_positive("--horizon", command_.horizon);
  require_at_least_one("--trajectories", command_.trajectories);
  require_sound(learning_at(1.0), "--learn-");
  if (command_.learn_horizon) require_positive("--learn-horizon", *command_.learn_horizon);
  require_positive("--hmc-temperature", command_.hmc_temperature);
  placement_asked(command_.placement);
  if (command_.metric == "distribution" || command_.metric == "acf") {
    refuse(
        "recommend ranks by errors along trajectories: --metric {} is not among path, state, exchange, "
        "energy, acceptance",
        command_.metric);
  }
  const double nominal = 1e-3 * command_.horizon;
  system_->require_measure(
      metric(), plan_at(nominal, command_.trajectories, seed_for(role::test, common_.seed)), {}, 1);
}

/// Those that repeat another at equal cost do not take part, nor letters O where there is no bath.
void recommendation::plan_classical() {
  for (const auto& name : method_names()) {
    if (name.ends_with("_2x")) continue;
    candidate its{.source = find_method(name), .where = {}};
    const bool has_bath = system_->its_bath().acts();
    if (its.source.fixed) {
      const tabulated& method = *its.source.fixed;
      if (!has_bath && method.letters().stochastic_letters > 0) continue;
      its.order = method.order;
      its.symmetric = method.symmetric;
      its.rotates = has_rotation(method.letters());
    } else {
      its.order = its.source.adaptive->properties.order;
      its.symmetric = its.source.adaptive->properties.symmetric;
    }
    consider(std::move(its));
  }
}

void recommendation::plan_families() {
  const auto names = command_.families.empty() ? family_names() : command_.families;
  const std::size_t before = all_.size();
  bool fixes = command_.learning.fix.empty();
  for (const auto& name : names) {
    const auto& family = family_named(name);
    if (!is_fixed_in(family)) continue;
    fixes = true;
    candidate its{.source = find_method("learned:" + name), .where = {}};
    its.order = family.order;
    its.symmetric = family.symmetric;
    its.rotates = has_rotation(family.letters);
    consider(std::move(its));
  }
  if (!fixes)
    refuse("--fix {}: no family that is learned here has such parameters", listed(command_.learning.fix));
  const bool asked = !command_.families.empty() || !command_.learning.fix.empty();
  if (all_.size() == before && asked) {
    refuse("{}: {}", left_out_.back().first, left_out_.back().second);
  }
}

bool recommendation::is_fixed_in(const run_time_family& family) const {
  const auto& names = family.parameter_names;
  return std::ranges::all_of(command_.learning.fix, [&](const std::string& text) {
    return std::ranges::find(names, text.substr(0, text.find('='))) != names.end();
  });
}

/// Takes part, or is left out with the reason why.
void recommendation::consider(candidate its) {
  const std::string name = its.source.typed;
  charge(its.source, *system_);
  const auto leave_out = [&](const std::string& why) { left_out_.emplace_back(name, why); };
  if ((command_.reversible || command_.metric == "acceptance") && !its.symmetric) {
    return leave_out("it is not reversible");
  }
  try {
    const auto otherwise = placement_asked(command_.placement);
    its.step = its.source.evaluations_per_step / command_.budget.value_or(system_->fastest_rate());
    if (its.is_learned()) its.where = placement_in(its.source, *system_, otherwise);
    if (command_.budget) {
      plan_at(its.step, command_.trajectories, 0);
      if (!its.is_learned()) {
        std::vector<std::string> ignored;  // what is not stable is seen to diverge
        its.method = coefficients_at(its.source, *system_, its.step, false, otherwise, ignored);
      }
    } else if (its.source.fixed) {
      system_->require_served(its.source.fixed->letters());
    }
    if (its.is_learned()) {
      system_->require_learnable(*its.source.family, its.where, learning_at(its.step), its.step);
    }
    all_.push_back(std::move(its));
  } catch (const refusal& problem) {
    leave_out(problem.what());
  } catch (const std::invalid_argument& problem) {
    leave_out(problem.what());
  }
}

/// Ten steps at least, so that there are pairs to learn from.
learn_settings recommendation::learning_at(double step) const {
  learn_settings how = command_.learning;
  how.horizon = command_.learn_horizon.value_or(std::max(0.5, 10.0 * step));
  return how;
}

trajectories_plan recommendation::plan_at(double step, std::int64_t count, std::uint64_t seed) const {
  return {step, steps_within("--horizon", command_.horizon, step), count, seed, common_.threads};
}

void recommendation::prepare(candidate& its, const std::vector<double>& from, bool from_there_alone) {
  its.reason.clear();
  try {
    if (!its.is_learned()) {
      std::vector<std::string> ignored;
      its.method = coefficients_at(its.source, *system_, its.step, false, placement_asked(command_.placement),
                                   ignored);
      return;
    }
    learn_plan plan = plan_for(*its.source.family, its.where, its.step, learning_at(its.step), common_);
    plan.from = from;
    plan.from_there_alone = from_there_alone;
    its.learned = learn_with(*system_, plan, shown_);
    its.method = its.learned->method;
    const fit_summary& fit = its.learned->fit;
    if (!fit.usable) its.reason = "the fit is not usable: " + fit.reason;
  } catch (const refusal& problem) {  // an adaptive method where it is not defined
    its.reason = problem.what();
  }
}

void recommendation::measure(const std::vector<candidate*>& all, std::int64_t count, std::uint64_t seed) {
  std::map<double, std::vector<candidate*>> by_step;  // they share the reference
  for (candidate* its : all) {
    if (its->reason.empty()) by_step[its->step].push_back(its);
  }
  for (const auto& [step, group] : by_step) measure_at(step, group, count, seed);
}

void recommendation::measure_at(double step, const std::vector<candidate*>& group, std::int64_t count,
                                std::uint64_t seed) {
  const trajectories_plan plan = plan_at(step, count, seed);
  shown_.part(fmt::format("comparing {} at step {:g}", group.size() == 1 ? "one" : "some", step));
  const auto take = [&](candidate& its, const auto& diverged_at) {
    its.diverged = std::ssize(diverged_at);
    if (its.diverged < count) return;
    const auto earliest = std::ranges::min(diverged_at, {}, &diverged_trajectory::step);
    its.reason = fmt::format("every trajectory diverged, the first of them at step {}", earliest.step);
  };
  if (command_.metric == "acceptance") {
    for (candidate* its : group) {
      const auto found = system_->acceptance(*its->method, plan, command_.hmc_temperature, {});
      its->error = {1.0 - found.probability.mean, found.probability.standard_error};
      its->of_each.clear();
      for (const double a : found.of_each) its->of_each.push_back(1.0 - a);
      its->evaluations_per_time = found.evaluations_per_time;
      take(*its, found.diverged_at);
    }
    return;
  }
  std::vector<tabulated> methods;
  for (const candidate* its : group) methods.push_back(*its->method);
  const errors_plan asked{
      .trajectories = plan, .metrics = {metric()}, .fine_step = system_->fine_step_for_ranking(step)};
  const auto found = system_->errors(methods, asked, shown_.counter(plan.count)).front();
  for (std::size_t k = 0; k < group.size(); ++k) {
    candidate& its = *group[k];
    const method_error& its_error = found.methods[k];
    its.error = its_error.error;
    its.of_each = its_error.of_each;
    its.evaluations_per_time = its_error.evaluations_per_time;
    if (found.reference_error) its.reference_error = found.reference_error->mean;
    its.reference = found.reference;
    take(its, its_error.diverged_at);
  }
}

void recommendation::measure_seconds() {
  shown_.part("timing");
  std::vector<candidate*> timed;
  std::vector<timed_method> methods;
  for (auto& its : all_) {
    if (!its.reason.empty()) continue;
    timed.push_back(&its);
    methods.push_back({*its.method,
                       plan_at(its.step, command_.trajectories, seed_for(role::test, common_.seed)),
                       its.evaluations_per_time});
  }
  if (methods.empty()) return;
  constexpr double all_rounds = 2.0;
  const auto seconds = seconds_per_time(*system_, methods, all_rounds);
  for (std::size_t i = 0; i < timed.size(); ++i) timed[i]->seconds_per_time = seconds[i].least;
}

/// A reference that errs like the method says nothing of it.
void recommendation::warn_of_reference() {
  for (const auto& its : all_) {
    if (!its.reference_error || !its.stands() || *its.reference_error <= 0.1 * its.error.mean) continue;
    warnings_.push_back(
        fmt::format("the reference's own error {:.1e} is not ten times smaller than that of {}, "
                    "{:.1e}",
                    *its.reference_error, its.source.typed, its.error.mean));
  }
}

}  // namespace nysalt::program
