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
  begin_group(command, "Cost or error");
  add_number(command, "--budget", asked.budget, "force evaluations per unit time that a method may take; or");
  add_number(command, "--budget-seconds", asked.budget_seconds,
             "seconds per unit time that one trajectory may take on this machine; or");
  add_number(command, "--error", asked.error, "the error to stay below, at the least cost");
  add_number(command, "--horizon", asked.horizon, "length of the runs to come, a time")->default_str("");
  command
      .add_option("--metric", asked.metric,
                  "the error: state (what is learned for), path, exchange, energy or acceptance")
      ->type_name(a_name)
      ->capture_default_str();
  add_number(command, "--trajectories", asked.trajectories,
             "number of trajectories to rank on; the best are measured on as many again");
  begin_group(command, more_of("Cost or error"));
  command.add_option("--observable", asked.observable, "the observable of path [that of the system]")
      ->type_name(a_name);
  add_number(command, "--looks", asked.looks,
             "number of observations of each trajectory of the runs to come: processed methods pay for each");
  begin_group(command, "With --for sampling, in place of cost or error");
  add_number(command, "--length", asked.sampling.length,
             "mean duration of trajectories, uniform from 0 to twice it")
      ->default_str("");
  add_number(command, "--acceptance", asked.sampling.acceptance,
             "with --for sampling: the mean acceptance at which steps are compared")
      ->group(more_of("Cost or error"));
  add_number(command, "--times-larger", asked.sampling.times_larger,
             "with --for sampling: how many times as large as this system the one is that will be sampled")
      ->group(more_of("Cost or error"));
  add_number(command, "--hmc-temperature", asked.hmc_temperature,
             "the temperature kT, an energy; that of --metric acceptance too");
  begin_group(command, method_options);
  command.add_option("--families", typed->families, "the families to learn [all that suit]")
      ->type_name(names);
  command.add_flag("--reversible", asked.reversible, "take symmetric methods only");
  add_placement(command, asked.placement);
  add_search(command, asked.learning, "--learn-");
  add_horizon(command, asked.learning, "--learn-");
  command.get_option("--learn-effort")
      ->description("how long to search: quick (as many families are learned), normal or thorough");
  begin_group(command, output_group);
  command.add_option("--output", asked.output, "the file to write: the method to take")->type_name(a_file);
  add_resume(command, asked.resume);
  add_json(command, common);
  add_verbose(command, common);
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
