// SPDX-License-Identifier: BSL-1.0
// A test whether starts are beyond the energies that a method was learned on, or outside by chance.
#pragma once

#include <algorithm>
#include <cstddef>
#include <ranges>
#include <string>

#include "nysalt/detail/energy_range.hpp"

namespace nysalt {

/// Number of n initial states with energies outside the range of M trajectories, the farthest by `farthest`.
///
/// A few always have. If all are of one distribution, their n + M energies are in any order equally likely,
/// and the number outside is beta-binomial [n; 2, M - 1], 2 n/(M + 1) in the mean. How far the largest of n
/// passes that of M depends on the distribution; where that falls exponentially, as Gibbs distributions do,
/// or faster, it is farther than t - 1 times the width of the range with a probability below n Gamma(1 + t)
/// M!/ Gamma(M + 1 + t). Chance is left aside if it would do this once in a thousand times.
struct energies_outside {
  static constexpr double chance = 1e-3;  ///< a probability below which chance is left aside

  energy_range seen;             ///< the energies of the data
  std::size_t trajectories = 0;  ///< M, of the data
  std::size_t examined = 0;      ///< n, starts
  std::size_t outside = 0;       ///< number of energies outside the range
  double farthest = 0.0;         ///< distance of the farthest energy from the range, an energy
  energy_range energies{};       ///< the energies of these starts

  /// Whether there are too many, or one is too far.
  bool is_serious() const { return outside > 0 && (probability() < chance || farthest > far()); }

  /// The probability that this number of n, or more, are outside by chance.
  double probability() const;

  /// The distance that none of n starts is beyond the range, but by a chance of one in a thousand. Infinite
  /// from one trajectory, which has no range.
  double far() const;

  /// A sentence with the numbers.
  std::string report() const;
};

/// Counts initial states by energy; one that is not finite is outside. Gentle motion is followed well: what
/// is below the range by less than a twentieth of its width counts as inside.
inline energies_outside count_outside(const energy_range& seen, std::size_t trajectories,
                                      const std::ranges::range auto& energies) {
  energies_outside result{.seen = seen, .trajectories = trajectories};
  const double gentle = seen.low - 0.05 * (seen.high - seen.low);
  for (const double energy : energies) {
    ++result.examined;
    result.energies.include(energy);
    if (seen.contains(energy) || (gentle <= energy && energy < seen.low)) continue;
    ++result.outside;
    result.farthest = std::max(result.farthest, seen.distance(energy));
  }
  return result;
}

}  // namespace nysalt
