// SPDX-License-Identifier: BSL-1.0
#include "nysalt/methods/classical.hpp"

#include <string>

namespace nysalt {

method detail::as_data(const detail::classical_row& row) {
  return {std::string(row.name),
          word(row.letters),
          {row.coefficients.begin(), row.coefficients.end()},
          {row.order, row.symmetric, row.requires_quadratic_kinetic}};
}

std::vector<method> classical_methods() {
  std::vector<method> result;
  for (const auto& row : detail::classical_table) {
    const bool is_for_baths = row.letters.find(ornstein_uhlenbeck::letter) != std::string_view::npos;
    if (!is_for_baths && !row.repeats) result.push_back(detail::as_data(row));
  }
  for (const auto& row : detail::processed_table) result.push_back(detail::as_data(row));
  return result;
}

}  // namespace nysalt
