// SPDX-License-Identifier: BSL-1.0
// The subcommands as the command line offers them: options, their help, and what runs when they are read.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <vector>

#include "../settings.hpp"

namespace nysalt::program {

struct subcommand {
  const CLI::App* options;
  /// Once they are read. Returns the exit code; throws refusal, also for options that do not go together.
  std::function<int()> run;
};

/// All of them, in the order of the help. Throws refusal if a parameter of a system that was loaded has the
/// name of an option.
std::vector<subcommand> offer_all(CLI::App& app, common_settings& common);

// Each is added to the program; its common options are read into `common`, which must outlive it.
subcommand offer_build(CLI::App& app, common_settings& common);
subcommand offer_cite(CLI::App& app, common_settings& common);
subcommand offer_compare(CLI::App& app, common_settings& common);
subcommand offer_export(CLI::App& app, common_settings& common);
subcommand offer_learn(CLI::App& app, common_settings& common);
subcommand offer_list(CLI::App& app, common_settings& common);
subcommand offer_new(CLI::App& app, common_settings& common);
subcommand offer_recommend(CLI::App& app, common_settings& common);
subcommand offer_run(CLI::App& app, common_settings& common);
subcommand offer_sample(CLI::App& app, common_settings& common);
subcommand offer_stability(CLI::App& app, common_settings& common);

}  // namespace nysalt::program
