// SPDX-License-Identifier: BSL-1.0
#include "subcommand.hpp"

#include <memory>
#include <string>
#include <vector>

#include "../comma_list.hpp"
#include "../commands.hpp"
#include "number_option.hpp"
#include "shared_options.hpp"

namespace nysalt::program {

subcommand offer_run(CLI::App& app, common_settings& common) {
  struct run_as_typed {
    run_command asked;
    std::vector<std::string> observables;
  };
  const auto typed = std::make_shared<run_as_typed>();
  auto& asked = typed->asked;
  auto& command = *app.add_subcommand("run", "trajectories of a method, sampled into a table");
  add_system(command, asked.system);
  begin_group(command, method_options);
  command
      .add_option("--method", asked.method,
                  "a name of nysalt list, word:LETTERS, or the file of a scheme or table")
      ->type_name(a_name)
      ->required();
  add_number(command, "--step", asked.step, "the step of the method, a time")->default_str("")->required();
  add_number(command, "--horizon", asked.horizon, "length of each trajectory, a time")
      ->default_str("")
      ->required();
  add_number(command, "--trajectories", asked.trajectories,
             "number of trajectories [1, or one for each state that is given]");
  add_placement(command, asked.placement);
  const auto leave_out = [&asked](std::int64_t times) { asked.checks = times == 0; };
  command
      .add_flag_function("--no-checks", leave_out,
                         "try neither the step nor a force of your own before the run")
      ->group(more_of(method_options));
  begin_group(command, output_group);
  command.add_option("--observables", typed->observables, "the observables to sample [that of the system]")
      ->type_name(names);
  add_number(command, "--sample-every", asked.sample_every, "number of steps between two samples");
  command.add_option("--output", asked.output, "the file to write: CSV, or .h5 or .npy [standard output]")
      ->type_name(a_file);
  command.add_flag("--plot", asked.plot, "draw the first trajectory, in pictures beside the output");
  add_json(command, common);
  add_resume(command, asked.resume);
  add_number(command, "--every", asked.every,
             "number of steps after which the state is saved [as often as takes a twentieth of the time]");
  command.add_flag("--keep-work", asked.keep_work,
                   "keep the work file in the end: with --resume a longer --horizon prolongs the run");
  add_common(command, common);
  add_force(command, common, "run a scheme at another step or system than it was learned for");
  command.footer(
      "Examples:\n"
      "  nysalt run --system fpu --method verlet --step 0.01 --horizon 1 --sample-every 10\n"
      "  nysalt run --system pendulum --method srkn6b --step 0.5 --horizon 100 --trajectories 8 "
      "--observables energy,q1 --output out.csv\n"
      "  nysalt run --system fpu --method verlet --step 0.001 --horizon 1e5 --sample-every 1000 --output "
      "out.csv --resume");
  const auto run_it = [typed, &asked, &common] {
    asked.observables = entries_of(typed->observables, "--observables");
    return run(asked, common);
  };
  return {&command, run_it};
}

}  // namespace nysalt::program
