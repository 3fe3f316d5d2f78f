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

/// Of one argument; the C++ calls each as of_NAME().
std::vector<std::string> functions_of_formulas();

/// Whether the grammar gives a name a meaning of its own: a function, sum or pi.
bool is_name_of_grammar(std::string_view name);

/// The expression in C++, of coordinates q[i] and parameters by their names. Throws refusal, with the place,
/// for what is not in the grammar, or does not depend on coordinates. Nothing of the text goes into the
/// result but names that are known and numbers.
std::string translated(std::string_view text, const std::vector<variable>& variables,
                       const std::vector<std::string>& parameters);

}  // namespace nysalt::program
