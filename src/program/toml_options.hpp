// SPDX-License-Identifier: BSL-1.0
// Options as TOML: what users write for --config, and what results record.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace nysalt::program {

/// Option of a TOML file.
struct toml_option {
  std::string section;              ///< TOML table of the option; empty: the top-level table
  std::string name;                 ///< key; empty for a section without options
  std::vector<std::string> values;  ///< a text for each element of a list; NAME=VALUE for each of a table
  bool is_table = false;            ///< whether the value is a table
  std::size_t line = 0;             ///< counted from 1
};

/// Options of a text, in the order of their lines. Tables at the top are sections, but for those in braces
/// and those of which is_option(name) holds. Throws refusal, in the name of `who` and with the line, for what
/// is not TOML 1.0, and for dates, lists within lists and tables of other depth.
std::vector<toml_option> options_in_toml(
    const std::string& text, const std::string& who,
    const std::function<bool(const std::string& name)>& is_option = [](const std::string&) { return false; });

/// Value as TOML: a number or a truth value where the text is how TOML writes it, else a text in quotes; a
/// list of several.
std::string as_toml(const std::vector<std::string>& values);

}  // namespace nysalt::program
