// SPDX-License-Identifier: BSL-1.0
#include "subcommand.hpp"

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "../comma_list.hpp"
#include "../commands.hpp"
#include "comparison/all_ranks.hpp"
#include "number_option.hpp"
#include "nysalt/communicator.hpp"
#include "shared_options.hpp"

namespace nysalt::program {

subcommand offer_stability(CLI::App& app, common_settings& common) {
  struct stability_as_typed {
    stability_command asked;
    system_settings system;
    std::vector<std::string> parameters;
  };
  const auto typed = std::make_shared<stability_as_typed>();
  auto& asked = typed->asked;
  auto& command = *app.add_subcommand("stability", "for which z = h omega a method is stable");
  begin_group(command, method_options);
  command.add_option("--method", asked.method, "a name of nysalt list, or the file of a scheme or table")
      ->type_name(a_name);
  command.add_option("--family", asked.family, "in place of --method: a family, with --parameters")
      ->type_name(a_name);
  command.add_option("--parameters", typed->parameters, "the values of the parameters of the family")
      ->type_name(numbers);
  auto of_system = add_system(command, typed->system);
  command.get_option("--system")
      ->description("a system, with --step: a name of nysalt list, or a file of your own");
  begin_group(command, method_options);
  of_system.push_back(
      add_number(command, "--step", asked.step, "with a system: the step at which the method is judged"));
  begin_group(command, output_group);
  command.add_option("--output", asked.output, "a CSV file to write: trace/2 of the step over z")
      ->type_name(a_file);
  command.add_flag("--plot", asked.plot,
                   "draw this curve beside the output, with its windows and the z of the system");
  add_json(command, common);
  add_verbose(command, common);
  add_common(command, common);
  add_force(command, common, "examine a scheme at another step or system than it was learned for");
  command.footer(
      "Examples:\n"
      "  nysalt stability --family nystrom --parameters 0.5,0.4\n"
      "  nysalt stability --method bcss3 --system fpu --step 0.04\n"
      "  nysalt stability --method mclachlan2 --system kepler --step 0.1 --output trace.csv --plot");
  const auto run_it = [typed, of_system, &asked, &common] {
    asked.parameters = numbers_of(typed->parameters, "--parameters");
    const auto is_given = [](const CLI::Option* option) { return option->count() > 0; };
    if (std::ranges::any_of(of_system, is_given)) asked.system = typed->system;
    int code = done;
    on_first(all_ranks(), [&] { code = stability(asked, common); });
    broadcast(all_ranks(), code);
    return code;
  };
  return {&command, run_it};
}

}  // namespace nysalt::program
