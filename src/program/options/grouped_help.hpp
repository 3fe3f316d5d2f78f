// SPDX-License-Identifier: BSL-1.0
// The help of a command: its options in groups, of which --help shows those that most runs need.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "../option_row.hpp"

namespace nysalt::program {

/// Options that are added from now on are of this group. Groups whose names end in ", more", and short forms
/// of parameters, are shown by --help-all alone.
void begin_group(CLI::App& command, const std::string& group);
/// "System, more"
std::string more_of(const std::string& group);
/// The group of "--omega 50", which is "--parameter omega=50".
inline constexpr const char* short_forms = "Short forms of --parameter";

/// -h and --help-all of a command, in the group of the general options.
void describe_help(CLI::App& command);

/// Lines of at most 110 columns. Of an option: its name, what it takes, its default in brackets, and a
/// phrase.
class grouped_help : public CLI::Formatter {
 public:
  grouped_help();
  std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override;
  std::string make_option(const CLI::Option* option, bool is_positional) const override;
  std::string make_option_opts(const CLI::Option* option) const override;

 private:
  std::string groups_of(const CLI::App& app, CLI::AppFormatMode mode) const;
};

}  // namespace nysalt::program
