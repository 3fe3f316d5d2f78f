// SPDX-License-Identifier: BSL-1.0
// Options of the command line, made from their rows.
#pragma once

#include <CLI/CLI.hpp>

#include "../settings.hpp"
#include "grouped_help.hpp"

namespace nysalt::program {

/// --version and --config, which belong to a program, and the form of its help.
void add_of_program(CLI::App& program);
/// Of a command; what they hold must outlive it.
void add_options(CLI::App& command, const option_rows& rows);
/// Those of every command, the last that are added.
void add_common(CLI::App& command, common_settings& common, const char* forced, bool has_details);
/// "--omega 50" of the bundled systems, which is "--parameter omega=50", and of systems that were loaded; and
/// --system is refused at once where there is none of that name.
void add_parameters(CLI::App& command, system_settings& system);

}  // namespace nysalt::program
