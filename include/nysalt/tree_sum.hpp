// SPDX-License-Identifier: BSL-1.0
// Sums over trajectories whose bits do not depend on who computed which.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

namespace nysalt {

/// terms[0] + terms[1] + ..., one term a trajectory: leaves of 16 consecutive terms, each summed in order,
/// then a binary tree in which neighbours are added level by level. The order is fixed by the number of
/// terms alone; a trajectory that does not count contributes a zero, so that it does not shift the others.
/// Throws std::invalid_argument if there is no term. Memory: a sixteenth of the terms.
template <class T>
T tree_sum(std::span<const T> terms) {
  constexpr std::size_t leaf = 16;
  if (terms.empty()) throw std::invalid_argument("tree_sum: there is nothing to add");
  std::vector<T> level;
  for (std::size_t first = 0; first < terms.size(); first += leaf) {
    const auto of_leaf = terms.subspan(first, std::min(leaf, terms.size() - first));
    T sum = of_leaf.front();
    for (const T& term : of_leaf.subspan(1)) sum += term;
    level.push_back(std::move(sum));
  }
  while (level.size() > 1) {
    std::size_t parents = 0;
    for (std::size_t i = 0; i < level.size(); i += 2, ++parents) {
      T sum = std::move(level[i]);
      if (i + 1 < level.size()) sum += level[i + 1];  // a last one without neighbour goes up alone
      level[parents] = std::move(sum);
    }
    level.resize(parents);
  }
  return level.front();
}

template <class T>
T tree_sum(const std::vector<T>& terms) {
  return tree_sum(std::span<const T>(terms));
}

}  // namespace nysalt
