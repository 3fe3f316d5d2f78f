// SPDX-License-Identifier: BSL-1.0
#include "contest.hpp"

#include <algorithm>

namespace nysalt::program {

bool contest::is_better(const candidate& a, const candidate& b) const {
  return budget ? error_of(a) < error_of(b) : cost_of(a) < cost_of(b);
}

void contest::rank() {
  const auto group = [](const candidate& contender) {
    if (contender.is_eligible()) return 0;
    return contender.is_left_behind ? 1 : contender.reason.empty() ? 2 : 3;
  };
  std::ranges::stable_sort(all, [&](const candidate& a, const candidate& b) {
    return group(a) != group(b) ? group(a) < group(b) : group(a) < 2 && is_better(a, b);
  });
}

const candidate* contest::best_of(bool learned) const {
  const auto found = std::ranges::find_if(all, [&](const candidate& contender) {
    return contender.is_eligible() && contender.is_learned() == learned;
  });
  return found == all.end() ? nullptr : &*found;
}

const candidate* contest::best() const {
  return !all.empty() && all.front().is_eligible() ? &all.front() : nullptr;
}

ratio_estimate contest::error_ratio(const candidate& a, const candidate& b) const {
  const bool both = a.confirmed && b.confirmed;
  const auto& of_a = both ? *a.confirmed : a.error;
  const auto& of_b = both ? *b.confirmed : b.error;
  return paired_ratio(of_a.scores, of_b.scores, statistic);
}

const candidate* contest::winner() const {
  const candidate* learned = best_of(true);
  const candidate* classical = best_of(false);
  if (learned == nullptr || classical == nullptr) return learned != nullptr ? learned : classical;
  if (budget) {
    const ratio_estimate ratio = error_ratio(*classical, *learned);
    if (ratio.is_above_one()) return learned;
    return ratio.is_below_one() ? classical : nullptr;
  }
  const double ratio = cost_of(*classical) / cost_of(*learned);
  if (ratio > cost_ratio) return learned;
  return ratio < 1.0 / cost_ratio ? classical : nullptr;
}

const candidate* contest::taken() const {
  const candidate* leader = winner();
  return leader != nullptr ? leader : best_of(false);
}

std::string contest::verdict() const {
  if (!has_result()) return "none";
  const candidate* leader = winner();
  if (leader == nullptr) return "tie";
  return leader->is_learned() ? "learned" : "classical";
}

}  // namespace nysalt::program
