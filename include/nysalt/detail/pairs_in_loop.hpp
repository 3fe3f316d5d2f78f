// SPDX-License-Identifier: BSL-1.0
// Drifts and kicks in turn, with coefficients that are read in a loop.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "nysalt/flows/drift.hpp"
#include "nysalt/flows/kick.hpp"

namespace nysalt::detail {

/// Which letter of a pair comes first.
enum class pair_begins { with_drift, with_kick };

/// Whether the force of the last kick is stored in the state.
enum class last_force { unknown, stored };

/// `steps` >= 1 times a drift and a kick, or a kick and a drift, for each of `count` pairs of coefficients.
/// The state is a local copy whose address is not taken, so that one of few coordinates stays in registers.
/// The loop over pairs must not be unrolled: g++ would keep the coefficients in registers and spill the
/// state, and take half as long again for six pairs.
template <pair_begins Begins, last_force Last, class T, System S>
[[gnu::always_inline]] inline void take_pairs(const S& system, auto& state, auto& room,
                                              const std::array<double, 2>* pairs, std::size_t count,
                                              std::int64_t steps) {
  constexpr bool stores_force = Last == last_force::stored;
  static_assert(!stores_force || Begins == pair_begins::with_drift);
  constexpr bool moves_force = S::dimension == Eigen::Dynamic;  // the room for it: kicks do not allocate
  flow_state<T, S::dimension> x;
  x.q = std::move(state.q);
  x.p = std::move(state.p);
  if constexpr (moves_force) x.f = std::move(state.f);
  asm("" : "+r"(count));  // a number that is known at compile time is unrolled in spite of the pragma
  for (std::int64_t n = 1; n <= steps; ++n) {
    const std::size_t end = stores_force && n == steps ? count - 1 : count;
#pragma GCC unroll 1
    for (std::size_t i = 0; i < end; ++i) {
      const double first = pairs[i][0];
      const double second = pairs[i][1];
      if constexpr (Begins == pair_begins::with_drift) {
        drift::apply(system, first, x, room);
        kick::evaluate_and_apply(system, second, x, room);
      } else {
        kick::evaluate_and_apply(system, first, x, room);
        drift::apply(system, second, x, room);
      }
    }
  }
  if constexpr (stores_force) {
    const double first = pairs[count - 1][0];
    const double second = pairs[count - 1][1];
    drift::apply(system, first, x, room);
    force_of<field::whole, T>(system, x.q, x.f);
    kick::apply(system, second, x, room);
  }
  state.q = std::move(x.q);
  state.p = std::move(x.p);
  if constexpr (moves_force || stores_force) state.f = std::move(x.f);
}

}  // namespace nysalt::detail
