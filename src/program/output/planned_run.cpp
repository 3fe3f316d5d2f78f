// SPDX-License-Identifier: BSL-1.0
#include "planned_run.hpp"

#include <algorithm>

#include "comparison/all_ranks.hpp"
#include "comparison/catalogue.hpp"
#include "comparison/checks.hpp"
#include "comparison/judging.hpp"
#include "comparison/lost_motion.hpp"
#include "comparison/refusal.hpp"
#include "nysalt/communicator.hpp"
#include "program/systems.hpp"
#include "report/result_file.hpp"

namespace nysalt::program {

namespace {

void require_observables(const run_command& command, const prepared_problem& system) {
  for (const auto& name : command.observables) system.require_observable(name);
  require_different("observables", command.observables);
}

trajectories_plan plan_of(const run_command& command, const prepared_problem& system,
                          const common_settings& common) {
  require_positive("step", command.step);
  const std::int64_t count = command.trajectories.value_or(system.given_states().value_or(1));
  require_at_least_one("trajectories", count);
  constexpr std::int64_t most = std::int64_t{1} << 48U;  // the number of trajectories with noise of their own
  if (count > most) refuse_value("trajectories", "must be at most 2^48 = {}, got {}", most, count);
  system.require_starts("trajectories", count);
  require_at_least_one("sample_every", command.sample_every);
  const std::int64_t steps = steps_within("horizon", command.horizon, command.step);
  return {command.step, steps, count, seed_for(role::test, common.seed), common.execution.threads};
}

/// A method that is fitted to a frequency needs it, also without checks.
bool is_fitted_to_frequency(const std::string& typed) {
  const std::string name = canonical_method(typed);
  return std::ranges::any_of(adaptive_methods(),
                             [&](const auto& known) { return name.starts_with(known.name); });
}

system_settings examined_as_asked(const run_command& asked) {
  system_settings settings = asked.system;
  if (!asked.checks) {
    settings.examined =
        is_fitted_to_frequency(asked.method) ? examination::frequency_only : examination::none;
  }
  return settings;
}

}  // namespace

planned_run::planned_run(const run_command& asked, const common_settings& common)
    : command(asked),
      system(make_system(examined_as_asked(asked))),
      plan(plan_of(asked, *system, common)),
      seed(common.seed) {
  if (command.observables.empty()) command.observables = {system->default_observable()};
  require_observables(command, *system);
  collectively(all_ranks(), [&] { source = find_method(command.method, command.held, system->letters()); });
  command.method = source.typed;  // of an alias the name
  method = coefficients_at(source, *system, command.step, common.force, placement_asked(command.placement),
                           warnings);
  unchecked.step = plan.step;
  unchecked.reason = "checks are left out, as asked";
}

const judgement& planned_run::judged() const {
  return command.checks ? system->judged_before(*method, plan) : unchecked;
}

std::optional<std::string> planned_run::warning_of_energy(double largest) const {
  // Of the kinetic energy: in proportion to time it becomes all of that in a run four times as long.
  constexpr double small = 0.25;
  const double kinetic = judged().kinetic_energy;
  if (!judged().energy_was_watched || !(largest > small * kinetic)) return std::nullopt;
  return fmt::format(
      "{} at step {:g}: at its end the energy errs by up to {:.2g}, {:.2g} times the median kinetic energy",
      command.method, plan.step, largest, largest / kinetic);
}

std::vector<std::string> planned_run::warnings_of_steps() const {
  std::vector<std::string> found;
  for (const auto& text :
       {warning_of(command.method, judged()), warning_of_energies(source, *system, plan)}) {
    if (text) found.push_back(*text);
  }
  if (!command.checks) return found;
  if (const auto text = warning_of_lost_motion(*system, plan)) found.push_back(*text);
  return found;
}

json planned_run::question() const {
  return {{"system", system->parameters()},
          {"starts", system->starts()},
          {"letters", method->letters().letters()},
          {"coefficients", method->coefficients()},
          {"step", command.step},
          {"steps", plan.steps},
          {"trajectories", plan.count},
          {"observables", command.observables},
          {"sample_every", command.sample_every},
          {"seed", seed}};
}

json planned_run::about() const {
  json result = written_by("nysalt run");
  result["description"] = system->description();
  result["method"] = command.method;
  result.update(question());
  result["units"] =
      "those of the system's Hamiltonian, in which nothing is scaled; t = step number * step; kinetic "
      "temperatures are energies (kT)";
  return result;
}

}  // namespace nysalt::program
