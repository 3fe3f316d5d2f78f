// SPDX-License-Identifier: BSL-1.0
#include "declared_prices.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <string>

#include "refusal.hpp"

namespace nysalt::program {

namespace {

/// A letter that kicks with parts; null of any other.
const detail::named_letter* kick_of_parts_in(const detail::named_letters& of_system, char letter) {
  const auto found =
      std::ranges::find_if(of_system, [&](const auto& one) { return one.letter->facts.letter == letter; });
  return found == of_system.end() || found->parts.empty() ? nullptr : &*found;
}

}  // namespace

void require_sound_prices(const std::vector<double>& prices, const detail::named_letters& of_system) {
  if (prices.empty()) return;
  std::size_t parts = 0;
  for (const auto& one : of_system) {
    for (const char part : one.parts) parts = std::max(parts, static_cast<std::size_t>(part - '0') + 1);
  }
  if (parts == 0)
    refuse(
        "--prices must be for a system with letters that kick with parts of its force, such as "
        "kick_of_part<0>, got a system without them; leave --prices out");
  if (prices.size() != parts)
    refuse("--prices must be {} numbers, one for each part of the force, got {}", parts, prices.size());
  for (const double price : prices) {
    if (!(price >= 0.0) || !std::isfinite(price))
      refuse("--prices must be finite numbers >= 0, got {:g}", price);
  }
  const double whole = std::accumulate(prices.begin(), prices.end(), 0.0);
  if (!(whole > 0.0) || !std::isfinite(whole))
    refuse("--prices must have a positive and finite sum, got {:g}", whole);
}

double priced_evaluations(const run_time_word& word, const std::vector<double>& prices,
                          const detail::named_letters& of_system) {
  double evaluations = word.evaluations_per_step;
  if (prices.empty()) return evaluations;
  const double whole = std::accumulate(prices.begin(), prices.end(), 0.0);
  const std::size_t first = word.merges ? 1 : 0;  // in the loop the first letter is merged with the last
  for (std::size_t i = first; i < word.length; ++i) {
    const detail::named_letter* kick = kick_of_parts_in(of_system, word.letters()[i]);
    if (kick == nullptr) continue;
    evaluations -= kick->letter->facts.displaced_forces;
    for (const char part : kick->parts) evaluations += prices[static_cast<std::size_t>(part - '0')] / whole;
  }
  return evaluations;
}

}  // namespace nysalt::program
