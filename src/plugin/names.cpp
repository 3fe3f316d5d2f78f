// SPDX-License-Identifier: BSL-1.0
#include "names.hpp"

#include <algorithm>
#include <array>

namespace nysalt::program {

bool is_reserved_name(std::string_view name) {
  constexpr std::array taken{"around",     "description", "friction",    "mass",   "name",     "parameter",
                             "parameters", "potential",   "sigma",       "source", "spread",   "start",
                             "starts",     "system",      "temperature", "text",   "variables"};
  return std::ranges::find(taken, name) != taken.end();
}

}  // namespace nysalt::program
