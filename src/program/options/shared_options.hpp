// SPDX-License-Identifier: BSL-1.0
// Options that several commands have.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "../settings.hpp"
#include "grouped_help.hpp"

namespace nysalt::program {

/// Groups of options in the help.
inline constexpr const char* system_options = "System";
inline constexpr const char* method_options = "Method";
inline constexpr const char* learning_group = "Learning";
inline constexpr const char* metric_group = "Metric";
inline constexpr const char* output_group = "Output";

/// What an option takes.
inline constexpr const char* a_name = "NAME";
inline constexpr const char* names = "NAME,...";
inline constexpr const char* numbers = "X,...";
inline constexpr const char* a_file = "FILE";

/// --version and --config, which belong to a program, and the form of its help.
void add_of_program(CLI::App& program);
/// The options of every command, the last that are added.
void add_common(CLI::App& command, common_settings& common);
/// --json, in the group that is under way.
void add_json(CLI::App& command, common_settings& common);
/// --resume, of commands that take long.
void add_resume(CLI::App& command, bool& resume);
/// --verbose, there too.
void add_verbose(CLI::App& command, common_settings& common);
/// Of the general options.
void add_force(CLI::App& command, common_settings& common, const char* what);

/// A system, what it is in, and where trajectories start in it. Returns the options.
std::vector<CLI::Option*> add_system(CLI::App& command, system_settings& system);

/// Options of methods in a bath.
void add_placement(CLI::App& command, std::string& placement);

/// Options of the search and of the data; some options begin with the prefix, "--" or "--learn-".
void add_search(CLI::App& command, learning_options& how, const std::string& prefix);
void add_horizon(CLI::App& command, learning_options& how, const std::string& prefix);
void add_learning(CLI::App& command, learning_options& how, const std::string& prefix);

}  // namespace nysalt::program
