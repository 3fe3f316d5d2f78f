// SPDX-License-Identifier: BSL-1.0
#include "declared_prices.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <string_view>

#include "refusal.hpp"

namespace nysalt::program {

void require_sound_prices(const std::vector<double>& prices, const std::vector<letter_facts>& of_system) {
  if (prices.empty()) return;
  std::size_t parts = 0;
  for (const auto& one : of_system) {
    for (const char part : one.parts.view())
      parts = std::max(parts, static_cast<std::size_t>(part - '0') + 1);
  }
  if (parts == 0)
    refuse_value(
        "prices",
        "must be for a system with letters that kick with parts of its force, such as kick_of_part<0>, "
        "got a system without them; leave {} out",
        spelled("prices"));
  if (prices.size() != parts)
    refuse_value("prices", "must be {} numbers, one for each part of the force, got {}", parts,
                 prices.size());
  for (const double price : prices) {
    if (!(price >= 0.0) || !std::isfinite(price))
      refuse_value("prices", "must be finite numbers >= 0, got {:g}", price);
  }
  const double whole = std::accumulate(prices.begin(), prices.end(), 0.0);
  if (!(whole > 0.0) || !std::isfinite(whole))
    refuse_value("prices", "must have a positive and finite sum, got {:g}", whole);
}

double priced_evaluations(const word& letters, const std::vector<double>& prices) {
  double evaluations = letters.evaluations_per_step;
  if (prices.empty()) return evaluations;
  const double whole = std::accumulate(prices.begin(), prices.end(), 0.0);
  for (std::size_t i = letters.first_in_loop(); i < letters.length; ++i) {
    const std::string_view parts = letters.facts(i).parts.view();
    if (parts.empty()) continue;
    evaluations -= letters.facts(i).displaced_forces;
    for (const char part : parts) evaluations += prices[static_cast<std::size_t>(part - '0')] / whole;
  }
  return evaluations;
}

}  // namespace nysalt::program
