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
  begin_group(command, method_options);
  command
      .add_option("--methods", typed->methods,
                  "names, word:LETTERS, learned:FAMILY, files; all: those of nysalt list [all]")
      ->type_name(names);
  command.add_option("--steps", typed->steps, "the steps at which each method is measured")
      ->type_name(numbers)
      ->required();
  command.add_flag("--equal-cost", asked.equal_cost,
                   "steps are per force evaluation: n evaluations make n times the step");
  add_number(command, "--horizon", asked.horizon,
             "length of each trajectory, a time [0.5, or ten of the largest steps if longer]");
  add_number(command, "--trajectories", asked.trajectories, "number of trajectories to measure errors on");
  add_placement(command, asked.placement);
  command
      .add_option("--prices", typed->prices,
                  "the prices of the forces of parts 0, 1, ...: an evaluation of a part counts as its share "
                  "of the whole force [each kick counts as one]")
      ->type_name(numbers)
      ->group(more_of(method_options));
  begin_group(command, metric_group);
  command
      .add_option("--metric", typed->metrics,
                  "which errors: path, state, energy, relative, exchange, acceptance, distribution, acf "
                  "[path, what an observer of the trajectory sees]")
      ->type_name(names);
  command
      .add_option("--observable", asked.observable,
                  "the observable of path, relative, distribution and acf [that of the system]")
      ->type_name(a_name);
  begin_group(command, more_of(metric_group));
  command.add_option("--range", typed->range, "the ends of the histogram of distribution [of the starts]")
      ->type_name("LOW,HIGH");
  add_number(command, "--bins", asked.bins, "number of bins of the histogram of distribution");
  add_number(command, "--longest-lag", asked.longest_lag,
             "the longest lag of the autocovariance acf, a time");
  add_number(command, "--hmc-temperature", asked.hmc_temperature,
             "the temperature kT of acceptance, an energy");
  command
      .add_option("--levels", typed->levels,
                  "errors for which the report says the cost of each method [chosen by the data]")
      ->type_name(numbers);
  add_learning(command, asked.learning, "--learn-");
  begin_group(command, output_group);
  command.add_option("--output", asked.output, "a folder to write: the report and its table")
      ->type_name("FOLDER");
  add_resume(command, asked.resume);
  add_json(command, common);
  add_verbose(command, common);
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
    const auto given = [&](const char* field) { return command.count(spelled(field)) > 0; };
    if (given("methods")) asked.methods = entries_of(typed->methods, "--methods");
    asked.steps = numbers_of(typed->steps, "--steps");
    asked.range = numbers_of(typed->range, "--range");
    asked.prices = numbers_of(typed->prices, "--prices");
    if (given("metric")) asked.metrics = entries_of(typed->metrics, "--metric");
    if (given("levels")) asked.levels = numbers_of(typed->levels, "--levels");
    require_fitting(asked, given);
    return compare(asked, common);
  };
  return {&command, run_it};
}

}  // namespace nysalt::program
