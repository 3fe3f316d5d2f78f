// SPDX-License-Identifier: BSL-1.0
#include "subcommand.hpp"

#include <memory>

#include "../commands.hpp"
#include "shared_options.hpp"

namespace nysalt::program {

subcommand offer_list(CLI::App& app, common_settings& common) {
  auto& command = *app.add_subcommand("list", "systems, methods, families and metrics");
  const auto asked = std::make_shared<list_command>();
  begin_group(command, system_options);
  command.add_option("--system", asked->system, "the file of a system of your own, which is listed too")
      ->type_name(a_file);
  begin_group(command, output_group);
  command.add_option("--schemas", asked->schemas, "write the JSON Schemas of the documents into the folder")
      ->type_name("FOLDER");
  add_json(command, common);
  add_common(command, common);
  command.footer("Examples:\n  nysalt list\n  nysalt list --json");
  return {&command, [asked, &common] { return list(*asked, common); }};
}

}  // namespace nysalt::program
