// SPDX-License-Identifier: BSL-1.0
// Sums over trajectories whose bits do not depend on who computed which.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

namespace nysalt {

namespace detail {

/// Those that are summed in order.
inline constexpr std::int64_t trajectories_of_leaf = 16;

template <class T>
std::vector<T> sums_of_leaves(std::span<const T> terms) {
  constexpr auto leaf = static_cast<std::size_t>(trajectories_of_leaf);
  std::vector<T> result;
  for (std::size_t first = 0; first < terms.size(); first += leaf) {
    const auto of_leaf = terms.subspan(first, std::min(leaf, terms.size() - first));
    T sum = of_leaf.front();
    for (const T& term : of_leaf.subspan(1)) sum += term;
    result.push_back(std::move(sum));
  }
  return result;
}

/// The next level of the tree; a last node without neighbour goes up unchanged.
template <class T>
void add_neighbours(std::vector<T>& level) {
  std::size_t parents = 0;
  for (std::size_t i = 0; i < level.size(); i += 2, ++parents) {
    T sum = std::move(level[i]);
    if (i + 1 < level.size()) sum += level[i + 1];
    level[parents] = std::move(sum);
  }
  level.erase(level.begin() + static_cast<std::ptrdiff_t>(parents), level.end());
}

}  // namespace detail

/// terms[0] + terms[1] + ..., one term a trajectory: leaves of 16 consecutive terms, each summed in order,
/// then a binary tree in which neighbours are added level by level. The order is fixed by the number of
/// terms only; a trajectory that does not count contributes a zero, so that it does not shift the others.
/// Throws std::invalid_argument if there is no term. Memory: a sixteenth of the terms.
template <class T>
T tree_sum(std::span<const T> terms) {
  if (terms.empty()) throw std::invalid_argument("tree_sum: terms must be one or more, got none");
  std::vector<T> level = detail::sums_of_leaves(terms);
  while (level.size() > 1) detail::add_neighbours(level);
  return level.front();
}

/// The same of a vector.
template <class T>
T tree_sum(const std::vector<T>& terms) {
  return tree_sum(std::span<const T>(terms));
}

}  // namespace nysalt
