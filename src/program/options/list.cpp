// SPDX-License-Identifier: BSL-1.0
#include "subcommand.hpp"

#include "../commands.hpp"
#include "shared_options.hpp"

namespace nysalt::program {

subcommand offer_list(CLI::App& app, common_settings& common) {
  auto& command = *app.add_subcommand("list", "systems, methods, families and metrics");
  add_common(command, common);
  command.footer("Examples:\n  nysalt list\n  nysalt list --json");
  return {&command, [&common] { return list(common); }};
}

}  // namespace nysalt::program
