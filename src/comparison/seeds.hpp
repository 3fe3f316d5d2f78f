// SPDX-License-Identifier: BSL-1.0
// One seed from the user, and apart from each other: what is learned from, judged on, tested with, and, of
// what won a test, measured with.
#pragma once

#include <cstdint>

namespace nysalt::program {

enum class role : std::uint64_t { training = 0, held_out = 1, test = 2, reference = 3, confirmation = 4 };

/// User's seeds lie below this, so that no role of one seed is a role of another, and those of the first four
/// roles, which are written into files, stay below 2^53: every reader of JSON takes them whole.
inline constexpr std::uint64_t seed_limit = std::uint64_t{1} << 51U;

/// The seed of a role: a key of its own, hence numbers of their own.
constexpr std::uint64_t seed_for(role which, std::uint64_t seed) {
  return static_cast<std::uint64_t>(which) * seed_limit + seed;
}

}  // namespace nysalt::program
