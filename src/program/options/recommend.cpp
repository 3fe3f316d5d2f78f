// SPDX-License-Identifier: BSL-1.0
#include "subcommand.hpp"

#include <memory>
#include <string>
#include <vector>

#include "../comma_list.hpp"
#include "../commands.hpp"
#include "comparison/refusal.hpp"
#include "number_option.hpp"
#include "shared_options.hpp"

namespace nysalt::program {

subcommand offer_recommend(CLI::App& app, common_settings& common) {
  struct recommend_as_typed {
    recommend_command asked;
    std::vector<std::string> families;
  };
  const auto typed = std::make_shared<recommend_as_typed>();
  auto& asked = typed->asked;
  auto& command = *app.add_subcommand("recommend", "the best method at a cost, or for an error");
  add_system(command, asked.system);
  add_placement(command, asked.placement);
  add_number(command, "--budget", asked.budget, "force evaluations per unit time");
  add_number(command, "--budget-seconds", asked.budget_seconds,
             "seconds per unit time of one trajectory, on this machine");
  add_number(command, "--error", asked.error, "to stay below, at the least cost");
  add_number(command, "--horizon", asked.horizon, "length of each trajectory")->default_str("")->required();
  add_number(command, "--trajectories", asked.trajectories, "to rank on");
  command.add_option("--metric", asked.metric, "path, state, exchange, energy or acceptance")
      ->capture_default_str();
  command.add_option("--observable", asked.observable, "of path [that of the system]");
  add_number(command, "--hmc-temperature", asked.hmc_temperature, "kT of the acceptance, an energy");
  add_number(command, "--looks", asked.looks,
             "how often each trajectory of later runs is looked at: processed methods pay for each look");
  command.add_flag("--reversible", asked.reversible, "symmetric methods alone");
  command.add_option("--families", typed->families, "to learn, joined by commas [all that suit]");
  add_search(command, asked.learning, "--learn-");
  add_horizon(command, asked.learning, "--learn-");
  command.add_option("--output", asked.output, "write the winner's scheme file");
  add_common(command, common);
  command.footer(
      "Examples:\n"
      "  nysalt recommend --system fpu --budget 80 --horizon 5 --output scheme.json\n"
      "  nysalt recommend --system henon_heiles --error 1e-4 --horizon 10 --reversible");
  const auto run_it = [typed, &asked, &command, &common] {
    asked.families = entries_of(typed->families, "--families");
    const auto belongs = [&](const char* option, const char* metric) {
      if (command.count(option) == 0 || asked.metric == metric) return;
      refuse("{} belongs to the metric {}, not to {}", option, metric, asked.metric);
    };
    belongs("--observable", "path");
    belongs("--hmc-temperature", "acceptance");
    return recommend(asked, common);
  };
  return {&command, run_it};
}

}  // namespace nysalt::program
