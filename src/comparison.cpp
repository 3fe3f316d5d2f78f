// SPDX-License-Identifier: BSL-1.0
#include "comparison.hpp"

#include <algorithm>
#include <cmath>

#include "catalogue.hpp"
#include "checks.hpp"
#include "learning.hpp"
#include "seconds.hpp"
#include "seeds.hpp"

namespace nysalt::program {

comparison::comparison(const compare_command& command, const common_settings& common)
    : command_(command), common_(common), system_(make_system(command.system)) {
  if (command_.observable.empty()) command_.observable = system_->default_observable();
  require_sound_command();
  plan_rows();
}

void comparison::learn_and_measure() {
  prepare_starts(*system_, common_, shown_);
  for (auto& its : rows_) {
    if (const auto family = families_.find(its.method); family != families_.end()) {
      learn_for(its, family->second);
    }
  }
  measure_errors();
  measure_seconds();
  shown_.clear();
  warn_of_reference();
}

bool comparison::has_result() const {
  return std::any_of(rows_.begin(), rows_.end(), [](const row& its) { return its.reason.empty(); });
}

void comparison::require_sound_command() const {
  if (command_.methods.empty()) refuse("--methods is needed, such as verlet,mclachlan2,learned:nystrom");
  if (command_.steps.empty()) refuse("--steps is needed, such as 0.01,0.02");
  for (const double step : command_.steps) {
    require_positive("--steps", step);
    if (std::count(command_.steps.begin(), command_.steps.end(), step) > 1) {
      refuse("--steps names {} twice", step);
    }
  }
  for (const auto& typed : command_.methods) {
    if (std::count(command_.methods.begin(), command_.methods.end(), typed) > 1) {
      refuse("--methods names {} twice", typed);
    }
  }
  require_at_least_one("--trajectories", command_.trajectories);
  require_sound(command_.learning, "--learn-");
  if (is_statistical()) require_sound_statistics();
  if (is_acceptance()) require_positive("--hmc-temperature", command_.hmc_temperature);
}

void comparison::plan_rows() {
  std::vector<method_source> sources;
  for (const auto& typed : command_.methods) {
    sources.push_back(find_method(typed));
    if (sources.back().family) families_[typed] = sources.back();
  }
  for (const double nominal : command_.steps) {
    for (const auto& source : sources) add_row(source, nominal);
  }
  for (const auto& source : sources) {
    const bool has_row =
        std::any_of(rows_.begin(), rows_.end(), [&](const row& its) { return its.method == source.typed; });
    if (has_row) continue;
    const double evaluations = command_.equal_cost ? source.evaluations_per_step : 1.0;
    refuse("{} was learned for {}, which --steps{} do not hold: add {}, or take --force", source.typed,
           source.learned->steps(), command_.equal_cost ? " (of an evaluation)" : "",
           source.learned->curve.steps().back() / evaluations);
  }
}

/// A scheme file has a row where its own step is asked for, and nowhere else.
void comparison::add_row(const method_source& source, double nominal) {
  const double step = command_.equal_cost ? nominal * source.evaluations_per_step : nominal;
  const bool elsewhere = source.learned && !is_at(*source.learned, step);
  if (elsewhere && !common_.force) return;
  row its{source.typed, nominal, step};
  const auto otherwise = placement_asked(command_.placement);
  int parts = 1;
  bool symmetric = false;
  if (source.family) {
    symmetric = family_named(*source.family).symmetric;
    steps_within("--learn-horizon", command_.learning.horizon, step);
    const auto where = placement_in(source, *system_, otherwise);
    system_->require_learnable(*source.family, where, command_.learning, step);
    if (where == placement::symmetric) parts = 2;
  } else {
    its.coefficients = coefficients_at(source, *system_, step, common_.force, otherwise, warnings_);
    symmetric = its.coefficients->symmetric;
    if (!is_statistical()) parts = noise_parts(*its.coefficients, *system_);
  }
  if (is_acceptance() && !symmetric && !system_->its_bath().acts()) {
    refuse("{} is not reversible, as the metric acceptance needs it: take a symmetric method", source.typed);
  }
  system_->require_measure(command_.metric, command_.observable, plan_at(step), command_.learning.fine_step,
                           parts);
  if (is_statistical()) statistics_at(step);
  rows_.push_back(std::move(its));
}

trajectories_plan comparison::plan_at(double step) const {
  return {step, steps_within("--horizon", command_.horizon, step), command_.trajectories,
          seed_for(role::test, common_.seed), common_.threads};
}

void comparison::learn_for(row& its, const method_source& source) {
  const auto where = placement_in(source, *system_, placement_asked(command_.placement));
  const learn_plan plan = plan_for(*source.family, where, its.step, command_.learning, common_);
  const learned_scheme learned = learn_with(*system_, plan, shown_);
  json fit{{"method", its.method}};
  fit.update(fit_json(learned.fit));
  fits_.push_back(fit);
  its.coefficients = learned.method;
  if (!learned.fit.usable) its.reason = "the fit is not usable: " + learned.fit.reason;
}

/// Rows at one step share the reference.
void comparison::measure_errors() {
  std::map<double, std::vector<row*>> by_step;
  for (auto& its : rows_) by_step[its.step].push_back(&its);
  for (const auto& [step, group] : by_step) {
    if (is_statistical()) {
      measure_statistics_at(step, group);
    } else if (is_acceptance()) {
      measure_acceptance_at(step, group);
    } else {
      measure_at(step, group);
    }
  }
}

std::vector<row*> comparison::usable(const std::vector<row*>& group, const trajectories_plan& plan) const {
  std::vector<row*> result;
  for (row* its : group) {
    if (its->reason.empty()) {
      result.push_back(its);
      continue;
    }
    const auto evaluations = static_cast<double>(system_->count_evaluations(*its->coefficients, plan));
    its->evaluations_per_time = evaluations / (static_cast<double>(plan.steps) * plan.step);
  }
  return result;
}

namespace {
std::string all_diverged(const std::vector<diverged_trajectory>& all) {
  const auto earliest = std::ranges::min(all, {}, &diverged_trajectory::step);
  return fmt::format("every trajectory diverged, the first of them at step {}", earliest.step);
}
}  // namespace

void comparison::measure_at(double step, const std::vector<row*>& group) {
  const trajectories_plan plan = plan_at(step);
  const std::vector<row*> measured = usable(group, plan);
  std::vector<tabulated> methods;
  for (const row* its : measured) methods.push_back(*its->coefficients);
  if (methods.empty()) return;
  shown_.part(fmt::format("comparing at step {:g}", step));
  const auto found = system_->errors(methods, plan, command_.metric, command_.observable,
                                     command_.learning.fine_step, shown_.counter(plan.count));
  if (!found.reference.empty()) {
    references_.push_back(
        {{"step_size", step}, {"reference", found.reference}, {"error", found.reference_error->mean}});
  }
  for (std::size_t k = 0; k < measured.size(); ++k) {
    row& its = *measured[k];
    its.error = found.methods[k].error;
    its.evaluations_per_time = found.methods[k].evaluations_per_time;
    its.diverged = found.methods[k].diverged;
    if (found.reference_error) its.reference_error = found.reference_error->mean;
    if (its.diverged == plan.count) its.reason = all_diverged(found.methods[k].diverged_at);
  }
}

void comparison::measure_acceptance_at(double step, const std::vector<row*>& group) {
  const trajectories_plan plan = plan_at(step);
  for (row* its : usable(group, plan)) {
    shown_.part(fmt::format("{} at step {:g}", its->method, its->nominal));
    const auto found =
        system_->acceptance(*its->coefficients, plan, command_.hmc_temperature, shown_.counter(plan.count));
    its->error = found.probability;
    its->evaluations_per_time = found.evaluations_per_time;
    its->diverged = std::ssize(found.diverged_at);
    if (its->diverged == plan.count) its->reason = all_diverged(found.diverged_at);
  }
}

void comparison::measure_seconds() {
  constexpr double all_rounds = 4.0;
  shown_.part("timing");
  std::vector<timed_method> methods;
  for (const auto& its : rows_) {
    methods.push_back({*its.coefficients, plan_at(its.step), its.evaluations_per_time});
  }
  const auto seconds = seconds_per_time(*system_, methods, all_rounds);
  for (std::size_t i = 0; i < rows_.size(); ++i) rows_[i].seconds_per_time = seconds[i];
}

/// A reference that errs like the method says nothing of it.
void comparison::warn_of_reference() {
  for (const auto& its : rows_) {
    if (!its.reference_error || std::isnan(its.error.mean)) continue;
    if (*its.reference_error <= 0.1 * its.error.mean) continue;
    warnings_.push_back(fmt::format(
        "the reference's own error {:.1e} is not ten times smaller than that of {} at step {:g}, {:.1e}",
        *its.reference_error, its.method, its.nominal, its.error.mean));
  }
}

}  // namespace nysalt::program
