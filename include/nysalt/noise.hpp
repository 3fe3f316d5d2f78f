// SPDX-License-Identifier: BSL-1.0
// Sources of the noise of a bath.
#pragma once

#include <concepts>
#include <cstdint>

#include "nysalt/phase_point.hpp"

namespace nysalt {

/// The letter of the bath in words.
inline constexpr char bath_letter = 'O';

/// Where in a run noise is wanted: by the letter O that is number `flow` among those of the word, in the step
/// from `step` to `step` + 1 of a trajectory. Lane l of a pack belongs to trajectory + l.
struct noise_place {
  std::uint64_t trajectory = 0;  ///< whose noise it is; that of lane 0
  std::int64_t step = 0;         ///< its number, from 0
  int flow = 0;                  ///< which letter O, from 0
};

// clang-format off
/// A source of standard normal numbers for the letters O of a run:
/// normals(place, xi)      for xi of the states that are stepped: xi_i become the standard normal numbers of
///                         that place, a pure function of it
/// draws_freely            true: numbers depend on no earlier ones; then the halves of a letter O in which one
///                         step ends and the next begins become one, and
/// halving(place, zeta)    are further ones, independent of the first, from which the halves are computed
///                         when they are observed. false: they belong to a path, which has its own halves
// clang-format on
template <class N>
concept NoiseSource = std::copyable<N> && requires {
  { N::draws_freely } -> std::convertible_to<bool>;
};

}  // namespace nysalt
