// SPDX-License-Identifier: BSL-1.0
// The system that a command names: bundled, of a file, or a potential.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "comparison/prepared_problem.hpp"
#include "settings.hpp"
#include "systems.hpp"

namespace nysalt::program {

/// The system that the settings name. Throws refusal for what it does not have.
std::unique_ptr<prepared_problem> make_system(const system_settings& settings);

/// What declares the system that the settings name; a source is compiled and a library loaded. Throws refusal
/// if there is none.
const system_declaration& declaration_in(const system_settings& settings);
/// A bundled system, or one that a file declares, which is loaded. Throws refusal if there is none of that
/// name, or what the file holds cannot be used.
const system_declaration& declaration_of(const std::string& name);
/// Of a parameter, for people; "none" for an empty text.
std::string text_of(const parameter_value& value);
/// "--mass-squared", the short form of a parameter
std::string option_of(std::string_view parameter);
/// "--parameter pairs=3,omega=50 --spread 1"
std::string options_of(const system_declaration& system);
/// Whether --start names a file of positions.
bool is_file_of_starts(const std::string& start);
/// The files that settings name, of starts and of data, with names of what they hold now.
std::map<std::string, std::string> files_of(const system_settings& settings);
/// A name that is the path of a file.
bool is_path_of_system(std::string_view name);

}  // namespace nysalt::program
