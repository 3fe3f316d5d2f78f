// SPDX-License-Identifier: BSL-1.0
#include "subcommand.hpp"

#include <memory>
#include <string>
#include <vector>

#include "../comma_list.hpp"
#include "../commands.hpp"
#include "shared_options.hpp"

namespace nysalt::program {

subcommand offer_cite(CLI::App& app, common_settings& common) {
  struct cite_as_typed {
    cite_command asked;
    std::vector<std::string> methods, metrics;
  };
  const auto typed = std::make_shared<cite_as_typed>();
  auto& asked = typed->asked;
  auto& command = *app.add_subcommand("cite", "the works that a set-up rests on, as BibTeX");
  command.add_option("files", asked.files, "scheme files and other results, which say how they were made")
      ->type_name(a_file);
  begin_group(command, "Set-up, in place of files");
  command.add_option("--system", asked.system, "the system: a name of nysalt list")->type_name(a_name);
  command
      .add_option("--methods", typed->methods, "the methods: names of nysalt list, learned:FAMILY, or files")
      ->type_name(names);
  command.add_option("--metric", typed->metrics, "the metrics, as nysalt compare takes them")
      ->type_name(names);
  command.add_flag("--bath", asked.in_bath, "the system is in a bath");
  begin_group(command, output_group);
  add_json(command, common);
  add_common(command, common);
  command.footer(
      "Examples:\n"
      "  nysalt cite --system fpu --methods srkn6b,learned:nystrom --metric path\n"
      "  nysalt cite --system pendulum --bath --methods baoab");
  const auto run_it = [typed, &asked, &common] {
    asked.methods = entries_of(typed->methods, "--methods");
    asked.metrics = entries_of(typed->metrics, "--metric");
    return cite(asked, common);
  };
  return {&command, run_it};
}

}  // namespace nysalt::program
