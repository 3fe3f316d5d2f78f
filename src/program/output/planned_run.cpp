// SPDX-License-Identifier: BSL-1.0
#include "planned_run.hpp"

#include <algorithm>
#include <span>

#include "comparison/checks.hpp"
#include "comparison/stability_margin.hpp"
#include "comparison/world.hpp"
#include "hdf5_layout.hpp"
#include "nysalt/detail/together.hpp"
#include "program/systems.hpp"
#include "report/manifest.hpp"

namespace nysalt::program {

namespace {

void require_observables(const run_command& command, const prepared_problem& system) {
  for (const auto& name : command.observables) system.require_observable(name);
  for (std::size_t i = 1; i < command.observables.size(); ++i) {
    const auto earlier = std::span(command.observables).first(i);
    if (std::ranges::find(earlier, command.observables[i]) == earlier.end()) continue;
    refuse("--observables names {} twice", command.observables[i]);
  }
}

std::int64_t steps_of(const run_command& command) {
  require_positive("--step", command.step);
  require_at_least_one("--trajectories", command.trajectories);
  require_at_least_one("--sample-every", command.sample_every);
  return steps_within("--horizon", command.horizon, command.step);
}

}  // namespace

planned_run::planned_run(const run_command& command, const common_settings& common)
    : command_(command), common_(common), system_(make_system(command.system)), steps_(steps_of(command)) {
  if (command_.observables.empty()) command_.observables = {system_->default_observable()};
  require_observables(command_, *system_);
  together(world(), [&] { source_ = find_method(command_.method, command_.held); });
  method_ = coefficients_at(source_, *system_, command_.step, common.force,
                            placement_asked(command_.placement), warnings_);
}

trajectories_plan planned_run::plan() const {
  return {command_.step, steps_, command_.trajectories, seed_for(role::test, common_.seed), common_.threads};
}

json planned_run::question() const {
  return {{"system", system_->parameters()},
          {"starts", system_->starts()},
          {"letters", method_->letters().letters()},
          {"coefficients", method_->coefficients()},
          {"step", command_.step},
          {"steps", steps_},
          {"trajectories", command_.trajectories},
          {"observables", command_.observables},
          {"sample_every", command_.sample_every},
          {"seed", common_.seed}};
}

json planned_run::about() const {
  json result{{"format", "nysalt run"}, {"format_version", 1}};
  json libraries = versions();
  result["nysalt"] = libraries["nysalt"];
  libraries.erase("nysalt");
  libraries["HDF5"] = hdf5_version();
  result["libraries"] = libraries;
  result["description"] = system_->description();
  result["method"] = command_.method;
  result.update(question());
  result["observables"] = listed(command_.observables);
  result["units"] =
      "those of the system's Hamiltonian, in which nothing is scaled; t = step number * step; kinetic "
      "temperatures are energies (kT)";
  return result;
}

std::vector<std::string> planned_run::warnings_of_starts() const {
  std::vector<std::string> found;
  const auto trajectories = plan();
  for (const auto& text :
       {stability_warning(command_.method, *method_, *system_, trajectories.step, trajectories.seed),
        failed_trial(command_.method, *method_, *system_, trajectories.step, trajectories.steps,
                     trajectories.seed, trajectories.threads),
        warning_of_energies(source_, *system_, trajectories)}) {
    if (text) found.push_back(*text);
  }
  return found;
}

}  // namespace nysalt::program
