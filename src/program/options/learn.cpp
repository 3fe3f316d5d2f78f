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

subcommand offer_learn(CLI::App& app, common_settings& common) {
  struct learn_as_typed {
    learn_command asked;
    std::vector<std::string> steps;
  };
  const auto typed = std::make_shared<learn_as_typed>();
  auto& asked = typed->asked;
  auto& command = *app.add_subcommand("learn", "fit a family to a system at a step");
  add_system(command, asked.system);
  begin_group(command, method_options);
  command.add_option("--family", asked.family, "the family of methods to learn, a name of nysalt list")
      ->type_name(a_name)
      ->capture_default_str();
  add_number(command, "--step", asked.step, "the step to learn for, a time");
  command
      .add_option("--steps", typed->steps, "in place of --step: several, for a curve of parameters over them")
      ->type_name(numbers);
  add_placement(command, asked.placement);
  add_learning(command, asked.learning, "--");
  command.get_option("--horizon")->group(learning_group);
  command.get_option("--fix")->group(learning_group);
  begin_group(command, learning_group);
  add_number(command, "--enough", asked.enough,
             "in place of --trajectories: as many as bring their share of the loss below X");
  begin_group(command, output_group);
  command.add_option("--output", asked.output, "the scheme file to write")->type_name(a_file);
  add_resume(command, asked.resume);
  add_json(command, common);
  add_verbose(command, common);
  add_common(command, common);
  add_force(command, common, "write the scheme even if the fit is not usable");
  command.footer(
      "Examples:\n"
      "  nysalt learn --system fpu --step 0.03 --output scheme.json\n"
      "  nysalt learn --system oscillator --parameter omega=50 --step 0.02 --coordinates energy --fix b1=0.5 "
      "--json\n"
      "  nysalt learn --system fpu --friction 0.01 --sigma 0.05 --placement symmetric --step 0.02\n"
      "  nysalt learn --system fpu --family fg4 --steps 0.04,0.05,0.06,0.07 --output curve.json");
  const auto run_it = [typed, &asked, &command, &common] {
    asked.steps = numbers_of(typed->steps, "--steps");
    if (command.count("--enough") > 0 && command.count("--trajectories") > 0) {
      refuse(
          "--enough must come without --trajectories, as it finds how many it takes; leave --trajectories "
          "away");
    }
    return learn(asked, common);
  };
  return {&command, run_it};
}

}  // namespace nysalt::program
