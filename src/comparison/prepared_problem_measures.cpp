// SPDX-License-Identifier: BSL-1.0
// Measurements of methods on a problem: errors, acceptance, statistics and costs.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "all_ranks.hpp"
#include "kept_answers.hpp"
#include "model_reference.hpp"
#include "nysalt/analysis/cost_against_error.hpp"
#include "nysalt/analysis/ensemble_statistics.hpp"
#include "nysalt/analysis/error_measures.hpp"
#include "nysalt/method.hpp"
#include "observables.hpp"
#include "prepared_problem.hpp"
#include "refusal.hpp"

namespace nysalt::program {

namespace {

trajectory_options options_of(const trajectories_plan& plan, const counter& progress = {}) {
  return {.step = plan.step,
          .steps = plan.steps,
          .trajectories = plan.count,
          .seed = plan.seed,
          .execution = {.threads = plan.threads, .ranks = &all_ranks(), .progress = progress},
          .horizon = plan.horizon};
}

/// What decides the bits of trajectories of methods.
json question_of(const char* what, std::span<const method> methods, const trajectories_plan& plan) {
  json question{what, plan.step, plan.steps, plan.count, plan.seed, plan.horizon.value_or(0.0)};
  for (const auto& method : methods) question.push_back({method.letters().letters(), method.coefficients()});
  return question;
}

// The end of a timed run, so that the compiler removes none.
volatile double end_of_run = 0.0;

/// Requirements of exchanges of energies on a system.
struct sprung_system {
  static constexpr int dimension = Eigen::Dynamic;
  nysalt::detail::stiff_springs springs;

  Eigen::Index size() const { return 0; }
  template <class U>
  void force(const vector<U, Eigen::Dynamic>&, vector<U, Eigen::Dynamic>&) const {
  }  // required by the concept, never called
  Eigen::Index pairs() const { return springs.pairs; }
  template <class U>
  U stiff_energy(const phase_point<U, Eigen::Dynamic>& x, Eigen::Index j) const {
    return springs.energy(x, j);
  }
};

}  // namespace

void prepared_problem::require_measure(const asked_metric& metric, const trajectories_plan& plan,
                                       std::optional<double> fine_step, int noise_parts) const {
  require_starts("trajectories", plan.count);
  if (metric.is_of_law()) {
    observable(made_, metric.observable);
    reference().fine_step_for_statistics(plan.step, fine_step);
    return;
  }
  if (metric.is_acceptance()) {
    if (made_.system.bath().acts()) {
      refuse("the metric acceptance must be of a system without a bath, which changes H; leave {} away",
             spelled("friction"));
    }
    detail::require_room(options_of(plan), 1, 1);
    return;
  }
  const auto measure = measure_named(metric);
  detail::require_room(options_of(plan), 1, measure.width);
  if (measure.needs_reference) reference().fine_step(plan.step, fine_step, noise_parts);
}

std::vector<trajectory_errors_result> prepared_problem::errors(const std::vector<method>& methods,
                                                               const errors_plan& plan,
                                                               const counter& progress) const {
  std::vector<error_measure> measures;
  for (const auto& metric : plan.metrics) measures.push_back(measure_named(metric));
  trajectory_options options = options_of(plan.trajectories, progress);
  options.null_model = plan.null_model;
  options.perturbation = plan.perturbation;
  const int parts = nysalt::detail::parts_of_noise(made_.system, methods);
  json question = question_of("errors", methods, plan.trajectories);
  question.push_back({plan.fine_step.value_or(0.0), plan.null_model, plan.perturbation.value_or(0.0)});
  for (const auto& metric : plan.metrics) question.push_back(metric.text());
  return once<std::vector<trajectory_errors_result>>(answers_, question, [&] {
    const auto reference_solution = reference().at(plan.trajectories.step, plan.fine_step, parts);
    return trajectory_errors(made_.system, reference_solution, *starts_, methods,
                             std::span<const error_measure>(measures), options);
  });
}

acceptance_result prepared_problem::acceptance(const method& method, const trajectories_plan& plan,
                                               double temperature, const counter& progress) const {
  json question = question_of("acceptance", std::span(&method, 1), plan);
  question.push_back(temperature);
  return once<acceptance_result>(answers_, question, [&] {
    return nysalt::acceptance(made_.system, method, *starts_, options_of(plan, progress), temperature);
  });
}

std::vector<double> prepared_problem::values_at_starts(const trajectories_plan& plan,
                                                       const std::string& name) const {
  const auto value = observable(made_, name);
  constexpr std::int64_t enough = 1000;
  std::vector<double> values;
  nysalt::detail::with_scalar_of(made_.system, [&]<class T>(T) {
    for (std::int64_t m = 0; m < std::min(plan.count, enough); m += lanes_in<T>) {
      const auto x = detail::sound_starts<T>(made_.system, *starts_, plan.seed, m, lanes_in<T>);
      for (int k = 0; k < lanes_in<T>; ++k) values.push_back(value(lane(x, k)));
    }
  });
  return values;
}

gathered_statistics prepared_problem::statistics(const method& method, const statistics_plan& plan,
                                                 const std::string& name, const counter& progress) const {
  const auto& trajectories = plan.trajectories;
  const auto stepper =
      make_stepper(made_.system, method, trajectories.step, counter_noise(trajectories.seed));
  const ensemble_options options{
      .trajectories = trajectories.count,
      .steps = trajectories.steps,
      .every = plan.every,
      .seed = trajectories.seed,
      .execution = {.threads = trajectories.threads, .ranks = &all_ranks(), .progress = progress},
      .first = plan.first};
  // Half a step on is where B(1/2) at the beginning of a word leads.
  const bool leaps = method.letters().letters().front() == kick::letter && method.coefficients()[0] == 0.5;
  const statistics_wanted wanted{.histogram = plan.bins,
                                 .lags = plan.lags,
                                 .moments = true,
                                 .kinetic_temperature = plan.bins.has_value(),
                                 .half_step_kinetic_temperature = plan.bins && leaps};
  return ensemble_statistics(stepper, *starts_, options, over_lanes(observable(made_, name)), wanted);
}

gathered_statistics prepared_problem::reference_statistics(const statistics_plan& plan,
                                                           const std::string& name,
                                                           std::optional<double> fine_step,
                                                           const counter& progress) const {
  const double fine = reference().fine_step_for_statistics(plan.trajectories.step, fine_step);
  const auto finer = std::llround(plan.trajectories.step / fine) * plan.finer;
  statistics_plan fine_plan = plan;
  fine_plan.trajectories.step = plan.trajectories.step / static_cast<double>(finer);
  fine_plan.trajectories.steps *= finer;
  fine_plan.every *= finer;
  return statistics(method_of_reference(made_.system), fine_plan, name, progress);
}

double prepared_problem::fastest_rate() const { return reference().fastest(); }

std::optional<double> prepared_problem::fine_step_for_ranking(double step) const {
  return reference().fine_step_for_ranking(step);
}

std::string prepared_problem::reference_of_statistics(double step, std::optional<double> fine_step) const {
  return fmt::format("{} with step {:.12g}", method_of_reference(made_.system).name(),
                     reference().fine_step_for_statistics(step, fine_step));
}

std::int64_t prepared_problem::count_evaluations(const method& method, const trajectories_plan& plan) const {
  return evaluations_of_run(made_.system, method, plan.step, plan.steps, (*starts_)(plan.seed, 0));
}

std::function<void()> prepared_problem::timed_run(const method& method, const trajectories_plan& plan) const {
  const auto stepper = make_stepper(made_.system, method, plan.step, counter_noise(plan.seed));
  return nysalt::detail::with_scalar_of(made_.system, [&]<class T>(T) -> std::function<void()> {
    std::vector<phase_point<T, Eigen::Dynamic>> starts;
    for (std::int64_t m = 0; m < plan.count; m += lanes_in<T>) {
      const auto count = static_cast<int>(std::min<std::int64_t>(lanes_in<T>, plan.count - m));
      starts.push_back(detail::sound_starts<T>(made_.system, *starts_, plan.seed, m, count));
    }
    return [stepper, starts = std::move(starts), steps = plan.steps] {
      for (const auto& start : starts) {
        auto run = stepper.open(start);
        stepper.advance(run, steps);
        end_of_run = lane(stepper.synchronous(run).q[0], 0);
      }
    };
  });
}

error_measure prepared_problem::measure_named(const asked_metric& metric) const {
  if (metric.name == "path")
    return path_measure(made_.system, over_lanes(observable(made_, metric.observable)));
  if (metric.name == "relative")
    return relative_measure(made_.system, over_lanes(observable(made_, metric.observable)));
  if (metric.name == "state") return state_measure(made_.system);
  if (metric.name == "energy") {
    if (made_.system.bath().acts())
      refuse("the metric energy must be of a system without a bath, which changes H; take path");
    return energy_measure(made_.system);
  }
  if (metric.name != "exchange") {
    refuse(
        "unknown metric '{}': it is one of path, relative, state, exchange, energy, acceptance, "
        "distribution, acf",
        metric.name);
  }
  if (made_.springs.pairs > 0) {
    return exchange_measure(sprung_system{made_.springs});
  } else {
    refuse("the metric exchange must be of a system with stiff springs, got {}; take path, state or energy",
           description());
  }
}

model_reference prepared_problem::reference() const {
  return {made_.system, made_.frequency, made_.fine_angle, made_.has_exact_flow, made_.exact};
}

}  // namespace nysalt::program
