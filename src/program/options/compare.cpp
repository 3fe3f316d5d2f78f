// SPDX-License-Identifier: BSL-1.0
#include "subcommand.hpp"

#include <memory>
#include <string>
#include <vector>

#include "../comma_list.hpp"
#include "../commands.hpp"
#include "comparison/comparison.hpp"
#include "number_option.hpp"
#include "shared_options.hpp"

namespace nysalt::program {

subcommand offer_compare(CLI::App& app, common_settings& common) {
  struct compare_as_typed {
    compare_command asked;
    std::vector<std::string> methods, steps, metrics, range, levels, prices;
  };
  const auto typed = std::make_shared<compare_as_typed>();
  auto& asked = typed->asked;
  auto& command = *app.add_subcommand("compare", "errors of methods beside their cost");
  add_system(command, asked.system);
  add_placement(command, asked.placement);
  command.add_option("--methods", typed->methods,
                     "names, word:LETTERS, learned:FAMILY, files, or all of nysalt list that apply; joined "
                     "by commas [all]");
  command.add_option("--steps", typed->steps, "joined by commas")->required();
  command.add_flag("--equal-cost", asked.equal_cost, "steps are per force evaluation");
  command.add_option(
      "--prices", typed->prices,
      "of the forces of parts 0, 1, ..., joined by commas: evaluations count as their shares of the "
      "whole force [each kick as one]");
  add_number(command, "--horizon", asked.horizon,
             "length of each trajectory [0.5, or ten of the largest steps if that is longer]");
  add_number(command, "--trajectories", asked.trajectories, "to compare on");
  command.add_option(
      "--metric", typed->metrics,
      "path, relative, state, exchange, energy, acceptance, distribution or acf, joined by commas; "
      "path:OBSERVABLE names that of one [path]");
  command.add_option("--observable", asked.observable,
                     "of path, relative, distribution and acf [that of the system]");
  command.add_option("--range", typed->range, "LOW,HIGH of the histogram [of the starts]");
  add_number(command, "--bins", asked.bins, "of the histogram");
  command.add_option("--levels", typed->levels,
                     "errors, joined by commas, whose cost the report has [those of the data]");
  add_number(command, "--longest-lag", asked.longest_lag, "of the autocovariance, a time");
  add_number(command, "--hmc-temperature", asked.hmc_temperature, "kT of the acceptance, an energy");
  add_learning(command, asked.learning, "--learn-");
  command.add_option("--output", asked.output, "folder for the report and its tables");
  command.add_flag("--resume", asked.resume, "go on where a run into the same folder was stopped");
  add_common(command, common);
  add_force(command, common, "use a scheme at another step or system than it was learned for");
  command.footer(
      "Examples:\n"
      "  nysalt compare --system fpu --methods verlet,bcss2,learned:nystrom --steps 0.02,0.03 "
      "--trajectories 100\n"
      "  nysalt compare --system fpu --methods all,learned:bab6 --steps 0.005,0.01 --equal-cost "
      "--metric state --json\n"
      "  nysalt compare --system fpu --friction 0.01 --sigma 0.05 --steps 0.019 --horizon 1 "
      "--methods baoab,baoab_2x,learned:nystrom@end,learned:nystrom@symmetric\n"
      "  nysalt compare --system henon_heiles --methods verlet,srkn6b,learned:fg4 --steps 0.2,0.4 "
      "--equal-cost "
      "--horizon 10 --learn-horizon 20 --trajectories 48 --metric state,energy --output report");
  const auto run_it = [typed, &asked, &command, &common] {
    const auto given = [&](const char* option) { return command.count(option) > 0; };
    if (given("--methods")) asked.methods = entries_of(typed->methods, "--methods");
    asked.steps = numbers_of(typed->steps, "--steps");
    asked.range = numbers_of(typed->range, "--range");
    asked.prices = numbers_of(typed->prices, "--prices");
    if (given("--metric")) asked.metrics = entries_of(typed->metrics, "--metric");
    if (given("--levels")) asked.levels = numbers_of(typed->levels, "--levels");
    require_fitting(asked, given);
    return compare(asked, common);
  };
  return {&command, run_it};
}

}  // namespace nysalt::program
