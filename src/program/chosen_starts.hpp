// SPDX-License-Identifier: BSL-1.0
// Where the trajectories of a bundled system start, as `--start` says.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <string>
#include <type_traits>
#include <utility>

#include "nysalt/ensembles/gibbs.hpp"
#include "nysalt/ensembles/gibbs_of_modes.hpp"
#include "nysalt/ensembles/one_long_trajectory.hpp"
#include "settings.hpp"

namespace nysalt::program {

/// An ensemble of any kind, for a system that is stepped in lanes of T and in double.
template <int N, class T>
class any_starts {
 public:
  template <class S, Ensemble<S> E>
  any_starts(const S& system, E ensemble)
      : text_(ensemble.description()), is_dear_(MakesBlocks<E, S, T>) {
    block_ = [&system, ensemble = std::move(ensemble)](std::uint64_t seed, std::int64_t first, int count) {
      return sound_starts<T>(system, ensemble, seed, first, count);
    };
  }

  /// The bits of a state do not depend on who is beside it.
  phase_point<double, N> operator()(std::uint64_t seed, std::uint64_t n) const {
    return lane(block_(seed, static_cast<std::int64_t>(n), 1), 0);
  }
  template <class U>
  phase_point<U, N> block(std::uint64_t seed, std::int64_t first, int count) const {
    const auto all = block_(seed, first, count);
    if constexpr (std::is_same_v<U, T>) {
      return all;
    } else {
      return gather<U, N>(std::min(count, lanes_in<U>), [&](int k) { return lane(all, k); });
    }
  }
  const std::string& description() const { return text_; }
  /// Whether a state takes a simulation of its own.
  bool is_dear() const { return is_dear_; }

 private:
  std::function<phase_point<T, N>(std::uint64_t, std::int64_t, int)> block_;
  std::string text_;
  bool is_dear_;
};

}  // namespace nysalt::program
