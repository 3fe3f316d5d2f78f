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

/// `steps` times a drift and a kick, or a kick and a drift, for each of `count` pairs of coefficients. The
/// state is a local copy whose address is not taken, so that one of few coordinates stays in registers. The
/// loop over pairs must not be unrolled: g++ would keep the coefficients in registers and spill the state,
/// and take half as long again for six pairs.
template <pair_begins Begins, class T, System S>
[[gnu::always_inline]] inline void take_pairs(const S& system, auto& state, auto& room,
                                              const std::array<double, 2>* pairs, std::size_t count,
                                              std::int64_t steps) {
  flow_state<T, S::dimension> x{{std::move(state.q), std::move(state.p)}, std::move(state.f)};
  asm("" : "+r"(count));  // a number that is known at compile time is unrolled in spite of the pragma
  for (std::int64_t n = 0; n < steps; ++n) {
#pragma GCC unroll 1
    for (std::size_t i = 0; i < count; ++i) {
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
  state.q = std::move(x.q);
  state.p = std::move(x.p);
  state.f = std::move(x.f);
}

}  // namespace nysalt::detail
