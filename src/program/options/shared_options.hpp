// SPDX-License-Identifier: BSL-1.0
// Options that several commands have.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "../settings.hpp"

namespace nysalt::program {

/// --version and --config, which belong to a program, and the width of its help.
void add_of_program(CLI::App& program);
/// The options of every command.
void add_common(CLI::App& command, common_settings& common);
void add_force(CLI::App& command, common_settings& common, const char* what);

/// A system, what it is in, and where trajectories start in it; `start` says what --start is. Returns the
/// options.
std::vector<CLI::Option*> add_system(CLI::App& command, system_settings& system,
                                     const char* start =
                                         "law, gibbs or trajectory, or a file of states: CSV, or .h5, .npy "
                                         "that run wrote [gibbs in a bath, else law]");

/// Options of methods in a bath.
void add_placement(CLI::App& command, std::string& placement);

/// Options of the search and of the data; some options begin with the prefix, "--" or "--learn-".
void add_search(CLI::App& command, learning_options& how, const std::string& prefix);
void add_horizon(CLI::App& command, learning_options& how, const std::string& prefix);
void add_learning(CLI::App& command, learning_options& how, const std::string& prefix);

}  // namespace nysalt::program
