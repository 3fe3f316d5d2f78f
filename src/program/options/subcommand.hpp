// SPDX-License-Identifier: BSL-1.0
// The subcommands as the command line offers them: options, their help, and what runs when they are read.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "shared_options.hpp"

namespace nysalt::program {

struct subcommand {
  const CLI::App* options;
  /// Once they are read. Returns the exit code; throws refusal, also for options that do not go together.
  std::function<int()> run;
};

/// All of them, in the order of the help. Throws refusal if a parameter of a system that was loaded has the
/// name of an option. The common options are read into `common`, which must outlive them.
std::vector<subcommand> offer_all(CLI::App& app, common_settings& common);

/// One of them, with the options of its rows; `complete` sees them when they are read, before it runs.
template <class Command>
subcommand offered(CLI::App& app, common_settings& common, const char* name, const char* what,
                   int (*run)(const Command&, const common_settings&), const std::string& footer,
                   const std::function<void(const CLI::App&, Command&)>& complete = {}) {
  const auto asked = std::make_shared<Command>();
  CLI::App& command = *app.add_subcommand(name, what);
  add_options(command, rows_of(*asked));
  if constexpr (requires { asked->system.parameters; }) add_parameters(command, asked->system);
  if constexpr (requires { asked->system->parameters; }) add_parameters(command, *asked->system);
  add_common(
      command, common, Command::forced, requires { Command::has_details; });
  command.footer("--config FILE holds options, as typed without the dashes (TOML).\n\n" + footer);
  const auto run_it = [asked, &command, &common, run, complete] {
    if (complete) complete(command, *asked);
    return run(*asked, common);
  };
  return {&command, run_it};
}

}  // namespace nysalt::program
