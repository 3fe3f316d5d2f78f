// SPDX-License-Identifier: BSL-1.0
// An option as a row: the command line, files of options, keywords of Python, and the tables of the documents
// are made from it.
#pragma once

#include <algorithm>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace nysalt::program {

using option_target =
    std::variant<bool*, int*, std::int64_t*, std::uint64_t*, double*, std::string*,
                 std::optional<std::int64_t>*, std::optional<double>*, std::optional<std::string>*,
                 std::vector<double>*, std::vector<std::string>*>;

/// Traits of an option, joined by |.
namespace trait {
inline constexpr unsigned needed = 1;        // it must be given
inline constexpr unsigned rare = 2;          // --help-all alone shows it
inline constexpr unsigned program_only = 4;  // no keyword of Python
inline constexpr unsigned positional = 8;    // a word without dashes, by its place
inline constexpr unsigned negated = 16;      // --no-NAME clears what is set
inline constexpr unsigned whole = 32;        // texts that are not split at commas
inline constexpr unsigned by_name = 64;      // name=value; in Python a dict of numbers
inline constexpr unsigned machine = 128;     // the default depends on the machine, and is not shown
}  // namespace trait

struct option_row {
  std::string field;  // as messages name it
  option_target to;   // what it holds before it is read is the default; 0 and what is empty are none
  std::string group;  // of the help
  std::string help;   // a phrase; {field} is another option, and brackets hold a default that is no value
  unsigned traits = 0;
  std::string takes{};     // empty: by the type
  std::string excludes{};  // the field of an option that must not be given too

  bool is(unsigned one) const { return (traits & one) != 0; }
};
using option_rows = std::vector<option_row>;

/// A text of a row, with the options that it names as the surface spells them.
std::string spelled_in(std::string_view text);
/// Messages and rows name options of the program from now on: --learn-horizon.
void spell_as_options();

inline option_rows joined(std::initializer_list<option_rows> parts) {
  option_rows all;
  for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

/// The row of a field, which is there.
inline option_row& row_of(option_rows& rows, std::string_view field) {
  return *std::ranges::find(rows, field, &option_row::field);
}

inline option_rows without(option_rows rows, std::string_view field) {
  std::erase_if(rows, [&](const option_row& row) { return row.field == field; });
  return rows;
}

inline option_rows with(option_rows rows, unsigned more) {
  for (auto& row : rows) row.traits |= more;
  return rows;
}

/// Groups of options in the help.
inline constexpr const char* in_system = "System";
inline constexpr const char* in_method = "Method";
inline constexpr const char* in_learning = "Learning";
inline constexpr const char* in_metric = "Metric";
inline constexpr const char* in_output = "Output";
inline constexpr const char* in_general = "General";

}  // namespace nysalt::program
