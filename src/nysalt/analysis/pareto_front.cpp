// SPDX-License-Identifier: BSL-1.0
#include "nysalt/analysis/pareto_front.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <tuple>
#include <vector>

namespace nysalt {

std::vector<std::size_t> pareto_front(std::span<const cost_and_error> all) {
  std::vector<std::size_t> candidates;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (std::isfinite(all[i].cost) && std::isfinite(all[i].error)) candidates.push_back(i);
  }
  std::ranges::sort(candidates, {}, [&](std::size_t i) { return std::tuple(all[i].cost, all[i].error, i); });
  std::vector<std::size_t> front;
  double least = std::numeric_limits<double>::infinity();
  for (const std::size_t i : candidates) {
    if (!(all[i].error < least)) continue;
    least = all[i].error;
    front.push_back(i);
  }
  return front;
}

}  // namespace nysalt
