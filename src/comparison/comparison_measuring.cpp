// SPDX-License-Identifier: BSL-1.0
// The work of a comparison, part by part: learning, errors along paths, acceptance, seconds.
#include <algorithm>
#include <cmath>
#include <set>

#include "catalogue.hpp"
#include "comparison.hpp"
#include "learning.hpp"
#include "method_file.hpp"
#include "nysalt/learning/fit_summary.hpp"
#include "ranking.hpp"
#include "refusal.hpp"
#include "seconds.hpp"

namespace nysalt::program {

namespace {

std::vector<row*> usable(const std::vector<row*>& all) {
  std::vector<row*> result;
  for (row* line : all) {
    if (line->reason.empty()) result.push_back(line);
  }
  return result;
}

}  // namespace

void comparison::learn_and_measure(work_file& kept) {
  prepare_starts(*system_, common_, shown_, warnings_);
  if (kept.found() > 0 && !kept.warning().empty()) warnings_.push_back(kept.warning());
  for (const auto& source : schemes_) {
    const auto of_energies = warning_of_energies(source, *system_, plan_at(rows_.front().step));
    if (of_energies) warnings_.push_back(*of_energies);
  }
  expect_work();
  const auto is_learned = [&](const row& line) { return families_.contains(line.method); };
  shown_.count(static_cast<std::size_t>(std::ranges::count_if(rows_, is_learned)), "fits");
  for (auto& line : rows_) {
    if (!is_learned(line)) continue;
    shown_.next();
    learn(line, kept);
  }
  std::map<double, group> by_step;  // rows at one step share the reference
  for (auto& line : rows_) {
    by_step[line.step].push_back(&line);
    const auto plan = plan_at(line.step);
    const auto evaluations = static_cast<double>(system_->count_evaluations(*line.coefficients, plan));
    line.evaluations_per_time =
        evaluations * line.share_of_evaluation / (static_cast<double>(plan.steps) * plan.step);
    if (line.reason.empty()) continue;
    for (measurement& one : line.measurements) one.reason = line.reason;
  }
  shown_.count(by_step.size(), "steps");
  for (const auto& [step, all] : by_step) {
    shown_.next();
    const auto has_samples = [this, at = step](const asked_metric& metric) {
      return too_few_samples(metric, at).empty();
    };
    if (std::ranges::any_of(along_paths(), has_samples)) measure_paths(step, usable(all), kept);
    for (std::size_t m = 0; m < metrics_.size(); ++m) {
      if (!has_samples(metrics_[m])) continue;
      if (metrics_[m].is_acceptance()) measure_acceptance(m, step, usable(all), kept);
      if (metrics_[m].is_of_law()) measure_law(m, step, usable(all), kept);
    }
  }
  shown_.count(0, {});
  judge_steps();
  if (options_.energies && !system_->heat_bath().acts()) follow_energies(kept);
  measure_seconds();
  shown_.clear();
  for (const auto& text : warnings_of_reference(*this)) warnings_.push_back(text);
}

/// An estimate of the work in force evaluations, by which progress shows the time that is left.
void comparison::expect_work() {
  double work = 0.0;
  std::map<double, group> by_step;
  for (auto& line : rows_) {
    by_step[line.step].push_back(&line);
    if (families_.contains(line.method)) work += work_of_learning(line);
  }
  for (const auto& [step, all] : by_step) {
    if (!along_paths().empty()) work += work_of_paths(all);
    for (const asked_metric& metric : metrics_) {
      if (!metric.is_of_law()) continue;
      work += 6.0 * work_of_reference();
      for (const row* line : all) work += work_of_law(evaluations_expected(*line));
    }
  }
  shown_.expect(work);
}

double comparison::evaluations_expected(const row& line) const {
  const auto family = families_.find(line.method);
  const int each = family != families_.end() ? family->second.evaluations_per_step
                                             : line.coefficients->letters().evaluations_per_step;
  return each / line.step;
}

/// A search takes some 0.2 s with two parameters and 6 s with six, for any data: as much as a few 10^7
/// evaluations, times the cube of their number.
double comparison::work_of_learning(const row& line) const {
  const auto parameters =
      static_cast<double>(family_named(*families_.at(line.method).family, system_->letters()).parameters());
  const learning_options& how = options_.learning;
  const double time = 2.0 * static_cast<double>(how.trajectories) * how.horizon_at(line.step);
  const double reference = 10.0 * system_->fastest_rate() / fine_angle * reference_evaluations;
  return 2e7 * std::pow(parameters, 3.0) + time * (reference + 1000.0 * evaluations_expected(line));
}

double comparison::work_of_paths(const group& all) const {
  double each = 2.0 * system_->fastest_rate() / fine_angle * reference_evaluations;
  for (const row* line : all) each += evaluations_expected(*line);
  return each * horizon_ * static_cast<double>(options_.trajectories);
}

double comparison::work_of_law(double evaluations_per_time) const {
  return evaluations_per_time * horizon_ * static_cast<double>(options_.trajectories);
}

double comparison::work_of_reference() const {
  return work_of_law(system_->fastest_rate() / fine_angle * reference_evaluations);
}

void comparison::learn(row& line, work_file& kept) {
  const method_source& source = families_.at(line.method);
  const auto where = placement_in(source, *system_, placement_asked(options_.placement));
  const std::string part = fmt::format("{} learned at {}", line.method, line.step);
  if (kept.has(part)) shown_.skip(work_of_learning(line));
  const nysalt::family family = placed(*source.family, where, system_->letters());
  const auto read = [&](const json& document) { return learned_row_from(document, line.method, family); };
  const learned_row found = kept.once(part, read, [&] {
    const learn_plan plan = plan_for(*source.family, where, line.step, options_.learning, common_);
    const learned_scheme learned = learn_with(*system_, plan, shown_, work_of_learning(line));
    return learned_row_of(fit_of(learned, options_.learning, where, line.method),
                          learned.fit.usable ? scheme_document({learned}, *system_, plan) : json(nullptr));
  });
  fits_.push_back(found);
  const auto theta = found.theta();
  const Eigen::VectorXd parameters = Eigen::Map<const Eigen::VectorXd>(theta.data(), std::ssize(theta));
  line.coefficients.emplace(
      family.name, family.letters, family.coefficients(parameters),
      method_properties{family.order, family.symmetric, family.requires_quadratic_kinetic});
  line.gains_nothing = found.gains_nothing();
  if (!found.usable) line.reason = "the fit is not usable: " + found.reason;
}

std::vector<asked_metric> comparison::along_paths() const {
  std::vector<asked_metric> result;
  std::ranges::copy_if(metrics_, std::back_inserter(result), &asked_metric::is_along_paths);
  return result;
}

/// The factor by which the reference should be finer for its error to be a hundred times below those of the
/// rows, as that falls with the sixth power of its step.
double comparison::refinement(const errors_plan& pilot, const std::vector<method>& methods) const {
  constexpr double share = 0.01;
  constexpr double order = 6.0;
  double most = 0.0;
  for (const auto& found : system_->errors(methods, pilot, {})) {
    if (!found.reference_error) continue;
    for (const method_error& method : found.methods) {
      if (!std::isnan(method.error.mean))
        most = std::max(most, found.reference_error->mean / method.error.mean);
    }
  }
  return std::pow(most / share, 1.0 / order);
}

/// Pilots on a few trajectories estimate the errors of the rows and of a coarse reference, which is refined
/// until it is good enough, or the usual one is.
std::optional<double> comparison::fine_step_for(double step, const std::vector<method>& methods) const {
  if (options_.learning.fine_step) return options_.learning.fine_step;
  const auto ranking = system_->fine_step_for_ranking(step);
  const auto paths = along_paths();
  const bool needs_one =
      std::ranges::any_of(paths, [](const asked_metric& metric) { return metric.name != "energy"; });
  if (!ranking || !needs_one) return std::nullopt;
  constexpr double coarser = 4.0;
  constexpr double usual = 10.0;  // the factor by which it is finer than for ranking
  constexpr std::int64_t few = 16;
  errors_plan pilot{.trajectories = paths_at(step), .metrics = paths};
  pilot.trajectories.count = std::min(few, options_.trajectories);
  double parts = std::max(1.0, std::round(step / (coarser * *ranking)));
  while (parts < usual * step / *ranking) {
    pilot.fine_step = step / parts;
    const double finer = refinement(pilot, methods);
    if (finer <= 1.0) return pilot.fine_step;
    constexpr double least = 1.3;  // where chaos hides how much finer the reference must be
    parts = std::ceil(std::max(finer, least) * parts);
  }
  return std::nullopt;
}

namespace {

std::vector<measurement> measurements_of(const std::vector<method_error>& all, std::int64_t trajectories) {
  std::vector<measurement> result;
  for (const method_error& method : all) {
    measurement one{
        .value = method.error, .spread = method.spread, .groups = means_of_groups(method.of_each)};
    one.lose(method.diverged_at, trajectories);
    result.push_back(std::move(one));
  }
  return result;
}

/// What the flow conserves stays at its start but for rounding: there is no null model then, and chaos does
/// not touch it.
bool is_conserved(const trajectory_errors_result& found) {
  constexpr double rounding = 1e-10;  // relative, over long runs
  constexpr double most = 1e-6;       // of a coarse reference; what chaos makes of its error is larger
  const double noise = found.reference_error ? std::min(10.0 * found.reference_error->mean, most) : 0.0;
  return found.null_model && found.null_model->mean <= std::max(noise, rounding);
}

baseline baseline_of_errors(const trajectory_errors_result& found) {
  baseline result{.reference = found.reference};
  if (found.reference_error) result.reference_error = found.reference_error->mean;
  if (!is_conserved(found)) {
    if (found.null_model) result.null_model = found.null_model->mean;
    result.predictable_until = found.predictable_until;
  }
  return result;
}

}  // namespace

void comparison::take(std::size_t metric, double step, const group& all, const measured& found) {
  baselines_[{metric, step}] = found.against;
  for (std::size_t k = 0; k < all.size(); ++k) all[k]->measurements[metric] = found.measurements.at(k);
}

void comparison::measure_paths(double step, const group& all, work_file& kept) {
  if (all.empty()) return;
  const std::string part = fmt::format("paths at {}", step);
  if (kept.has(part)) {
    shown_.skip(work_of_paths(all));
  } else {
    shown_.part(fmt::format("comparing at step {:g}", step), work_of_paths(all));
  }
  const auto read = [&](const json& text) {
    return measured_from(text, along_paths().size(), all.size(), options_.trajectories);
  };
  const auto found = kept.once(part, read, [&] {
    std::vector<method> methods;
    for (const row* line : all) methods.push_back(*line->coefficients);
    constexpr double perturbation = 1e-6;
    const errors_plan plan{.trajectories = paths_at(step),
                           .metrics = along_paths(),
                           .fine_step = fine_step_for(step, methods),
                           .null_model = true,
                           .perturbation = perturbation};
    std::vector<measured> result;
    for (const auto& errors : system_->errors(methods, plan, shown_.counter(options_.trajectories))) {
      result.push_back({baseline_of_errors(errors), measurements_of(errors.methods, options_.trajectories)});
    }
    return result;
  });
  std::size_t next = 0;
  for (std::size_t m = 0; m < metrics_.size(); ++m) {
    if (metrics_[m].is_along_paths()) take(m, step, all, found.at(next++));
  }
}

void comparison::measure_acceptance(std::size_t metric, double step, const group& all, work_file& kept) {
  shown_.part(fmt::format("acceptance at step {:g}", step));
  const std::string part = fmt::format("{} at {}", metrics_[metric].text(), step);
  const auto read = [&](const json& text) {
    return measured_from(text, 1, all.size(), options_.trajectories);
  };
  const auto found = kept.once(part, read, [&] {
    measured result;
    for (const row* line : all) {
      const auto accepted = system_->acceptance(*line->coefficients, plan_at(step), options_.hmc_temperature,
                                                shown_.counter(options_.trajectories));
      measurement one{.value = accepted.probability, .groups = means_of_groups(accepted.of_each)};
      one.lose(accepted.diverged_at, options_.trajectories);
      result.measurements.push_back(std::move(one));
    }
    return std::vector{result};
  });
  take(metric, step, all, found.front());
}

void comparison::measure_seconds() {
  constexpr double all_rounds = 4.0;
  shown_.part("timing");
  std::vector<timed_method> methods;
  for (const auto& line : rows_) {
    methods.push_back({*line.coefficients, plan_at(line.step), line.evaluations_per_time});
  }
  const auto seconds = seconds_per_time(*system_, methods, all_rounds);
  for (std::size_t i = 0; i < rows_.size(); ++i) rows_[i].seconds_per_time = seconds[i];
}

}  // namespace nysalt::program
