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

/// The parts whose forces a letter evaluates, a digit for each; empty of letters that kick with no part.
std::string parts_of(char letter, const detail::named_letters& of_system) {
  const auto found =
      std::ranges::find_if(of_system, [&](const auto& one) { return one.letter->facts.letter == letter; });
  if (found == of_system.end() || found->letter->facts.displaced_forces == 0) return {};
  const bool are_parts = std::ranges::all_of(found->times, [](char c) { return '0' <= c && c <= '9'; });
  return are_parts ? found->times : std::string();
}

}  // namespace

void require_sound_prices(const std::vector<double>& prices, const detail::named_letters& of_system) {
  if (prices.empty()) return;
  std::size_t parts = 0;
  for (const auto& one : of_system) {
    for (const char part : parts_of(one.letter->facts.letter, of_system))
      parts = std::max(parts, static_cast<std::size_t>(part - '0') + 1);
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
  if (std::ranges::max(prices) == 0.0) refuse("--prices must hold a positive number, got zeros only");
}

double priced_evaluations(const run_time_word& word, const std::vector<double>& prices,
                          const detail::named_letters& of_system) {
  double evaluations = word.evaluations_per_step;
  if (prices.empty()) return evaluations;
  const double whole = std::accumulate(prices.begin(), prices.end(), 0.0);
  const std::size_t first = word.merges ? 1 : 0;  // in the loop the first letter is merged with the last
  for (std::size_t i = first; i < word.length; ++i) {
    for (const char part : parts_of(word.letters()[i], of_system))
      evaluations += prices[static_cast<std::size_t>(part - '0')] / whole - 1.0;
  }
  return evaluations;
}

}  // namespace nysalt::program
