// SPDX-License-Identifier: BSL-1.0
// A formula in coordinates and parameters, by a strict grammar, as C++.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace nysalt::program {

inline constexpr std::int64_t most_coordinates = 100'000;

/// Some coordinates: one, or as many as are numbered from 1 on.
struct variable {
  std::string name;
  std::int64_t first;  // in q
  std::int64_t count;
  bool is_list;
};

/// Letters, digits and _, no digit first.
bool is_name(std::string_view text);

/// Names of all functions of the grammar.
std::vector<std::string> functions_of_formulas();

/// The C++ of what an expression calls: of_NAME() for each function of C++.
std::string code_of_functions();

/// Whether no variable, parameter or counter may have a name, as it is that of a function. The constants pi
/// and e yield to what has their name.
bool is_name_of_grammar(std::string_view name);

/// The expression in C++, of coordinates q[i] and parameters by their names. Throws refusal, with the place,
/// for what is not in the grammar. Names in upper case stand for those in lower case where there is no other.
/// Nothing of the text goes into the result but names that are known and numbers.
std::string translated(std::string_view text, const std::vector<variable>& variables,
                       const std::vector<std::string>& parameters);

}  // namespace nysalt::program
