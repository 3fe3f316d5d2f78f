// SPDX-License-Identifier: BSL-1.0
#include "subcommand.hpp"

#include <memory>

#include "../commands.hpp"
#include "shared_options.hpp"

namespace nysalt::program {

subcommand offer_list(CLI::App& app, common_settings& common) {
  auto& command = *app.add_subcommand("list", "systems, methods, families and metrics");
  const auto asked = std::make_shared<list_command>();
  command.add_option("--system", asked->system, "the file of your own, to be listed too");
  add_common(command, common);
  command.footer("Examples:\n  nysalt list\n  nysalt list --json");
  return {&command, [asked, &common] { return list(*asked, common); }};
}

}  // namespace nysalt::program
