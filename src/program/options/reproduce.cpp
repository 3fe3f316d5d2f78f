// SPDX-License-Identifier: BSL-1.0
#include "subcommand.hpp"

#include <memory>

#include "../commands.hpp"
#include "shared_options.hpp"

namespace nysalt::program {

subcommand offer_reproduce(CLI::App& app, common_settings& common) {
  const auto asked = std::make_shared<reproduce_command>();
  auto& command = *app.add_subcommand("reproduce", "the paper's tables and figures beside our own");
  command.add_option("parts", asked->parts, "linear, deterministic, langevin [all; some ten minutes]");
  command.add_option("--output", asked->output, "folder for paper.md, paper.html, paper.json and pictures");
  command.add_flag("--quick", asked->quick, "few trajectories and steps, to see it run");
  add_common(command, common);
  command.footer(
      "Examples:\n"
      "  nysalt reproduce linear\n"
      "  nysalt reproduce deterministic langevin --quick --output results");
  return {&command, [asked, &common] { return reproduce(*asked, common); }};
}

}  // namespace nysalt::program
