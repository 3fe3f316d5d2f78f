// SPDX-License-Identifier: BSL-1.0
// Options from a file.
#pragma once

#include <CLI/CLI.hpp>
#include <istream>
#include <string>
#include <vector>

#include "toml_options.hpp"

namespace nysalt::program {

std::vector<std::string> command_names(const CLI::App& app);
std::vector<std::string> option_names(const CLI::App& command);
/// "nysalt learn --help lists the options"
std::string help_of(const CLI::App& command);

/// TOML. Options outside of a [section] belong to the command that runs, and so do those of its section.
class options_file : public CLI::Config {
 public:
  explicit options_file(const CLI::App& app) : app_(app) {}

  /// Options that were given, a line each: what results record, and --config takes.
  std::string to_config(const CLI::App* app, bool default_also, bool write_description,
                        std::string prefix) const override;
  std::vector<CLI::ConfigItem> from_config(std::istream& input) const override;

 private:
  /// Throws refusal for an unknown section or option, and for a value of another kind than the option takes.
  void require_known(const toml_option& option, const std::string& running, const std::string& where) const;

  /// Throws refusal for a system that is a file, and was not typed. What is loaded is known when the command
  /// line is read, and its options come from there.
  void require_no_code(const toml_option& option, const std::string& running, const std::string& who) const;

  const CLI::App& app_;
};

}  // namespace nysalt::program
