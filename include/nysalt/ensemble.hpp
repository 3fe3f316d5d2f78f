// SPDX-License-Identifier: BSL-1.0
// Where trajectories start.
#pragma once

#include <concepts>
#include <cstdint>
#include <string>

#include "nysalt/system.hpp"

namespace nysalt {

/// ensemble(seed, n) is the start of trajectory n: a pure function, so that any trajectory can be made
/// alone, in any order. `description()` says what it is, for provenance.
template <class E, class S>
concept Ensemble = requires(const E& ensemble, std::uint64_t seed, std::uint64_t n) {
  { ensemble(seed, n) } -> std::same_as<phase_point<double, S::dimension>>;
  { ensemble.description() } -> std::convertible_to<std::string>;
};

}  // namespace nysalt
