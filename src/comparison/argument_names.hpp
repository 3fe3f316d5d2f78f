// SPDX-License-Identifier: BSL-1.0
// Messages that name options, for callers who have arguments instead.
#pragma once

#include <string>

namespace nysalt::program {

/// The names by which a caller writes the options of the program.
struct argument_spelling {
  const char* learning;  // what replaces "--learn-"
  const char* yes;       // behind the name of an option without a value
};
inline constexpr argument_spelling in_python{"learn_", "=True"};
inline constexpr argument_spelling in_cpp{"learning.", " = true"};

/// "--equal-cost" becomes "equal_cost=True", and so on; command lines that are proposed stay as they are.
std::string with_arguments(const std::string& text, const argument_spelling& spelling);

}  // namespace nysalt::program
