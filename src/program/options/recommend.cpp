// SPDX-License-Identifier: BSL-1.0
#include "subcommand.hpp"

#include <memory>
#include <string>
#include <vector>

#include "../comma_list.hpp"
#include "../commands.hpp"
#include "../systems.hpp"
#include "comparison/purpose.hpp"
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
  add_number(command, "--horizon", asked.horizon, "length of each trajectory")->default_str("");
  add_number(command, "--length", asked.sampling.length,
             "for sampling: mean duration of a trajectory, which is uniform between 0 and twice that")
      ->default_str("");
  add_number(command, "--acceptance", asked.sampling.acceptance, "for sampling: at which steps are compared");
  add_number(command, "--times-larger", asked.sampling.times_larger,
             "for sampling: size of the system that will be sampled over the size of this one");
  add_number(command, "--trajectories", asked.trajectories, "to rank on");
  command.add_option("--metric", asked.metric, "path, state, exchange, energy or acceptance")
      ->capture_default_str();
  command.add_option("--observable", asked.observable, "of path [that of the system]");
  add_number(command, "--hmc-temperature", asked.hmc_temperature, "kT of the acceptance, an energy");
  add_number(command, "--looks", asked.looks,
             "observations of each trajectory of later runs: processed methods pay for each observation");
  command.add_flag("--reversible", asked.reversible, "symmetric methods only");
  command.add_option("--families", typed->families, "to learn, joined by commas [all that suit]");
  add_search(command, asked.learning, "--learn-");
  add_horizon(command, asked.learning, "--learn-");
  command.add_option("--output", asked.output, "write the winner's scheme file");
  add_common(command, common);
  command.footer(
      "Examples:\n"
      "  nysalt recommend --system fpu --budget 80 --horizon 5 --output scheme.json\n"
      "  nysalt recommend --system henon_heiles --error 1e-4 --horizon 10 --reversible\n"
      "  nysalt recommend --for sampling --system phi4 --length 1 --families bab5 --times-larger 100");
  const auto run_it = [typed, &asked, &command, &common] {
    asked.families = entries_of(typed->families, "--families");
    if (asked.learning.purpose == for_sampling) {
      for (const char* option : {"--budget", "--budget-seconds", "--error", "--horizon", "--metric",
                                 "--observable", "--looks", "--reversible", "--placement"}) {
        if (command.count(option) > 0)
          refuse("{0} must come with another purpose than --for sampling; leave {0} out", option);
      }
      if (command.count("--length") == 0) {
        refuse("--length must be given with --for sampling; a quarter of the slowest period is a good start");
      }
      sampling_options& sampling = asked.sampling;
      sampling.temperature = asked.hmc_temperature;
      sampling.trajectories = asked.trajectories;
      sampling.families = asked.families;
      sampling.learning = asked.learning;
      sampling.starts_are_thermal = is_file_of_starts(asked.system.start);
      auto& of_momenta = asked.system.bath.temperature;  // of the starts in a file
      if (sampling.starts_are_thermal && of_momenta.value_or(sampling.temperature) != sampling.temperature) {
        refuse("--temperature {} must be the --hmc-temperature, got {}", *of_momenta, sampling.temperature);
      }
      if (sampling.starts_are_thermal) of_momenta = sampling.temperature;
      return recommend(asked, common);
    }
    for (const char* option : {"--length", "--acceptance", "--times-larger"}) {
      if (command.count(option) > 0) refuse("{} must come with --for sampling; leave {} out", option, option);
    }
    if (command.count("--horizon") == 0)
      refuse("--horizon must be given; name the length of the runs to come");
    const auto belongs = [&](const char* option, const char* metric) {
      if (command.count(option) == 0 || asked.metric == metric) return;
      refuse("{} must come with the metric {}, got {}", option, metric, asked.metric);
    };
    belongs("--observable", "path");
    belongs("--hmc-temperature", "acceptance");
    return recommend(asked, common);
  };
  return {&command, run_it};
}

}  // namespace nysalt::program
