// SPDX-License-Identifier: BSL-1.0
// Sources of the noise of a bath.
#pragma once

#include <concepts>
#include <cstdint>

#include "nysalt/phase_point.hpp"

namespace nysalt {

/// The letter of the bath in words.
inline constexpr char bath_letter = 'O';

/// Position of noise in a run: the letter O that is number `flow` among those of the word, in the step
/// from `step` to `step` + 1 of a trajectory. Lane l of a pack belongs to trajectory + l.
struct noise_place {
  std::uint64_t trajectory = 0;  ///< trajectory number, of lane 0
  std::int64_t step = 0;         ///< step number, from 0
  int flow = 0;                  ///< number of the letter O in the word, from 0
};

// clang-format off
/// A source of standard normal numbers for the letters O of a run:
/// normals(place, xi)      for xi of the states that are stepped: xi_i become the standard normal numbers of
///                         that place, a pure function of it
/// is_memoryless            true: numbers depend on no earlier ones; then the halves of a letter O in which one
///                         step ends and the next begins become one, and
/// halving(place, zeta)    are further ones, independent of the first, from which the halves are computed
///                         when they are observed. false: they belong to a path, which has its own halves
// clang-format on
template <class N>
concept NoiseSource = std::copyable<N> && requires {
  { N::is_memoryless } -> std::convertible_to<bool>;
};

/// A noise source for runs without noise: no letter O, or a bath with sigma = 0. A stepper refuses it
/// otherwise.
struct no_noise {
  static constexpr bool is_memoryless = false;

  template <class T, int N>
  void normals(const noise_place&, vector<T, N>&) const {}
};

}  // namespace nysalt
