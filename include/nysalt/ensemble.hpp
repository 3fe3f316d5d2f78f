// SPDX-License-Identifier: BSL-1.0
// Where trajectories start.
#pragma once

#include <fmt/format.h>

#include <concepts>
#include <cstdint>
#include <stdexcept>
#include <string>

#include "nysalt/lanes.hpp"

namespace nysalt {

/// ensemble(seed, n) is the start of trajectory n: a pure function, so that any trajectory can be made
/// alone, in any order. `description()` says what it is, for provenance.
template <class E, class S>
concept Ensemble = requires(const E& ensemble, std::uint64_t seed, std::uint64_t n) {
  { ensemble(seed, n) } -> std::same_as<phase_point<double, S::dimension>>;
  { ensemble.description() } -> std::convertible_to<std::string>;
};

/// The start of trajectory n. Throws std::invalid_argument if it is not finite or does not fit.
template <System S, Ensemble<S> E>
phase_point<double, S::dimension> sound_start(const S& system, const E& ensemble, std::uint64_t seed,
                                              std::int64_t n) {
  auto start = ensemble(seed, static_cast<std::uint64_t>(n));
  if (start.q.size() == size(system) && start.p.size() == size(system) && is_finite(start)) return start;
  throw std::invalid_argument(fmt::format("start {} of {} is not finite or has not the dimension of {}", n,
                                          ensemble.description(), describe(system)));
}

/// Those of `count` trajectories from the first on, one in each lane of T.
template <class T, System S, Ensemble<S> E>
phase_point<T, S::dimension> sound_starts(const S& system, const E& ensemble, std::uint64_t seed,
                                          std::int64_t first, int count) {
  return gather<T, S::dimension>(count,
                                 [&](int k) { return sound_start(system, ensemble, seed, first + k); });
}

}  // namespace nysalt
