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
  command
      .add_option("--method", asked.method,
                  "a symmetric one: a name of nysalt list, or the file of a scheme or table")
      ->capture_default_str();
  add_number(command, "--step", asked.step, "of the method; with --acceptance a first guess");
  add_number(command, "--acceptance", asked.acceptance,
             "to which the burn-in tunes the step [0.9, unless there is a --step]");
  add_number(command, "--length", asked.length,
             "mean duration of a trajectory, which is uniform between 0 and twice that [pi/2 with "
             "--diagonal-masses]");
  add_number(command, "--hmc-temperature", asked.temperature, "kT, an energy");
  add_number(command, "--chains", asked.chains, "independent ones");
  add_number(command, "--burn-in", asked.burn_in, "trajectories of a chain before the first draw");
  add_number(command, "--draws", asked.draws, "of each chain");
  command.add_flag("--diagonal-masses", asked.diagonal_masses,
                   "masses kT/var(q_i), found in the first half of the burn-in");
  command.add_option("--output", asked.output, "file of all draws: CSV");
  command.add_option("--checkpoint", asked.checkpoint, "file to go on from if the chains are stopped");
  add_number(command, "--every", asked.every, "trajectories of a chain between two checkpoints");
  command.add_flag("--resume", asked.resume, "go on from the checkpoint");
  add_common(command, common);
  add_force(command, common, "sample with a scheme at another step or system than it was learned for");
  command.footer(
      "Examples:\n"
      "  nysalt sample --system phi4 --masses 64 --length 1 --method omelyan5v\n"
      "  nysalt sample --potential '(x^2 + 100*y^2)/2' --variables x,y --diagonal-masses --output draws.csv\n"
      "  nysalt sample --system phi4_lattice --side 8 --length 0.5 --output draws.csv --checkpoint "
      "draws.checkpoint --every 500\n"
      "  nysalt sample --system pendulum --method verlet --step 0.5 --length 2 --draws 10000");
  return {&command, [typed, &common] { return sample(*typed, common); }};
}

}  // namespace nysalt::program
