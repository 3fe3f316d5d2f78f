// SPDX-License-Identifier: BSL-1.0
// Starts of an ensemble, rare energetic ones among them.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <utility>
#include <vector>

#include "nysalt/energy.hpp"
#include "nysalt/ensemble.hpp"

namespace nysalt {

/// How many of typical_and_energetic_starts() come first, as the ensemble gives them.
inline constexpr std::size_t plain_starts = 128;

/// Starts of an ensemble from number `first` on: 128 in its order and the 64 most energetic of 896 that come
/// next, as energetic starts, which are rare, meet the highest frequencies; fewer where states are large, or
/// the ensemble has no more. Of an ensemble whose states are dear to make, `most_of_dear` and 64 at most.
template <SeparableSystem S, Ensemble<S> E>
std::vector<phase_point<double, S::dimension>> typical_and_energetic_starts(
    const S& system, const E& ensemble, std::uint64_t seed, std::int64_t first, std::int64_t most_of_dear) {
  using T = scalar_of_lanes<lanes_of<S>>;
  using state = phase_point<double, S::dimension>;
  constexpr auto plain = static_cast<std::int64_t>(plain_starts);
  constexpr std::int64_t energetic = 64;
  constexpr std::int64_t pool = 896;
  constexpr double numbers = 2e6;  // 16 MB
  bool is_dear = MakesBlocks<E, S, T>;
  if constexpr (requires { ensemble.is_dear(); }) is_dear = ensemble.is_dear();
  const auto that_fit = static_cast<std::int64_t>(numbers / (2.0 * static_cast<double>(size(system))));
  std::int64_t most = std::min(is_dear ? std::min(energetic, most_of_dear) : plain + pool, that_fit);
  if constexpr (requires { ensemble.size(); }) {
    most = std::min(most, static_cast<std::int64_t>(ensemble.size()) - first);
  }
  std::vector<state> result;
  std::vector<std::pair<double, state>> by_energy;
  for (std::int64_t n = 0; n < most; n += lanes_of<S>) {
    const auto count = static_cast<int>(std::min<std::int64_t>(lanes_of<S>, most - n));
    phase_point<T, S::dimension> block;
    try {
      block = sound_starts<T>(system, ensemble, seed, first + n, count);
    } catch (const std::exception&) {  // it has no more
      break;
    }
    for (int k = 0; k < count; ++k) {
      state start = lane(block, k);
      if (n + k < plain) {
        result.push_back(std::move(start));
      } else if constexpr (HasEnergy<S>) {
        if (!has_energy(system)) continue;
        by_energy.emplace_back(nysalt::energy<double>(system, start), std::move(start));
      }
    }
  }
  const auto taken = std::min<std::ptrdiff_t>(energetic, std::ssize(by_energy));
  const auto is_higher = [](const auto& a, const auto& b) { return a.first > b.first; };
  std::partial_sort(by_energy.begin(), by_energy.begin() + taken, by_energy.end(), is_higher);
  for (std::ptrdiff_t k = 0; k < taken; ++k) {
    result.push_back(std::move(by_energy[static_cast<std::size_t>(k)].second));
  }
  return result;
}

}  // namespace nysalt
