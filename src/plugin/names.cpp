// SPDX-License-Identifier: BSL-1.0
#include "names.hpp"

#include <algorithm>
#include <array>
#include <cctype>

namespace nysalt::program {

std::string in_lower_case(std::string_view text) {
  std::string result(text);
  std::ranges::transform(result, result.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return result;
}

bool is_reserved_name(std::string_view name) {
  constexpr std::array taken{"around",     "description", "friction",    "mass",   "name",     "parameter",
                             "parameters", "potential",   "sigma",       "source", "spread",   "start",
                             "starts",     "system",      "temperature", "text",   "variables"};
  return std::ranges::find(taken, name) != taken.end();
}

}  // namespace nysalt::program
