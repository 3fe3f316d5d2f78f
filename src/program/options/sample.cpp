// SPDX-License-Identifier: BSL-1.0
#include "subcommand.hpp"

#include <memory>

#include "../commands.hpp"
#include "number_option.hpp"
#include "shared_options.hpp"

namespace nysalt::program {

subcommand offer_sample(CLI::App& app, common_settings& common) {
  const auto typed = std::make_shared<sample_command>();
  auto& asked = *typed;
  auto& command = *app.add_subcommand("sample", "draws from exp(-V/kT) by Hybrid Monte Carlo");
  add_system(command, asked.system);
  begin_group(command, method_options);
  command
      .add_option("--method", asked.method,
                  "a symmetric method: a name of nysalt list, or the file of a scheme or table")
      ->type_name(a_name)
      ->capture_default_str();
  add_number(command, "--step", asked.step, "the step of the method; with --acceptance a first guess");
  add_number(command, "--acceptance", asked.acceptance,
             "the mean acceptance that the burn-in tunes the step to [0.9 without --step]");
  add_number(command, "--length", asked.length,
             "mean duration of trajectories, uniform from 0 to twice it [pi/2 for --diagonal-masses]");
  add_number(command, "--hmc-temperature", asked.temperature, "the temperature kT of exp(-V/kT), an energy");
  command.add_flag("--diagonal-masses", asked.diagonal_masses,
                   "masses kT/var(q_i), found in the first half of the burn-in");
  begin_group(command, "Chains");
  add_number(command, "--chains", asked.chains, "number of independent chains");
  add_number(command, "--burn-in", asked.burn_in, "trajectories of each chain before its first draw");
  add_number(command, "--draws", asked.draws, "draws of each chain");
  begin_group(command, output_group);
  command.add_option("--output", asked.output, "a CSV file to write, of all draws")->type_name(a_file);
  add_json(command, common);
  add_resume(command, asked.resume);
  add_number(
      command, "--every", asked.every,
      "trajectories of a chain after which the state is saved [as often as takes a twentieth of the time]");
  add_common(command, common);
  add_force(command, common, "sample with a scheme at another step or system than it was learned for");
  command.footer(
      "Examples:\n"
      "  nysalt sample --system phi4 --parameter masses=64 --length 1 --method omelyan5v\n"
      "  nysalt sample --potential '(x^2 + 100*y^2)/2' --variables x,y --diagonal-masses --output draws.csv\n"
      "  nysalt sample --system phi4_lattice --parameter side=8 --length 0.5 --output draws.csv --resume\n"
      "  nysalt sample --system pendulum --method verlet --step 0.5 --length 2 --draws 10000");
  return {&command, [typed, &common] { return sample(*typed, common); }};
}

}  // namespace nysalt::program
