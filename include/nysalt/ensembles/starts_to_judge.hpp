// SPDX-License-Identifier: BSL-1.0
// States at which methods are judged: typical states and states of high energy.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "nysalt/initial_states.hpp"
#include "nysalt/model.hpp"
#include "nysalt/phase_point.hpp"

namespace nysalt {

/// Starts to judge methods on: the first 512 of an ensemble by a seed of their own, 64 of one whose states
/// are expensive to make, fewer where it has no more or they are large; in a bath repeated up to 192.
phase_points starts_to_judge(const model& system, const initial_states& ensemble);

// Starts of an ensemble, rare energetic ones among them.

namespace detail {

/// Number of the typical starts, which come first in typical_and_energetic_starts().
inline constexpr std::size_t plain_starts = 128;

/// Starts of an ensemble from number `first` on: 128 in its order and the 64 most energetic of 896 that come
/// next, as energetic starts, which are rare, meet the highest frequencies; fewer where states are large, or
/// the ensemble has no more. Of an ensemble whose states are expensive to make, `most_if_expensive` and 64 at
/// most.
std::vector<phase_point<double, Eigen::Dynamic>> typical_and_energetic_starts(const model& system,
                                                                              const initial_states& ensemble,
                                                                              std::uint64_t seed,
                                                                              std::int64_t first,
                                                                              std::int64_t most_if_expensive);

}  // namespace detail

}  // namespace nysalt
