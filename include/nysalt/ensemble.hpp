// SPDX-License-Identifier: BSL-1.0
// Distributions of initial states.
#pragma once

#include <cmath>
#include <concepts>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>

#include "nysalt/core/sentence.hpp"
#include "nysalt/lanes.hpp"

namespace nysalt {

/// ensemble(seed, n) is the start of trajectory n: a pure function, so that any trajectory can be made
/// without the others, in any order. `description()` says what it is, for provenance.
template <class E, class S>
concept Ensemble = requires(const E& ensemble, std::uint64_t seed, std::uint64_t n) {
  { ensemble(seed, n) } -> std::same_as<phase_point<double, S::dimension>>;
  { ensemble.description() } -> std::convertible_to<std::string>;
};

/// An ensemble whose states are expensive may make the states of `count` trajectories at a time, one in each
/// lane of T, with the same bits: block<T>(seed, first, count).
template <class E, class S, class T>
concept MakesBlocks =
    Ensemble<E, S> && requires(const E& ensemble, std::uint64_t seed, std::int64_t first, int count) {
      { ensemble.template block<T>(seed, first, count) } -> std::same_as<phase_point<T, S::dimension>>;
    };

namespace detail {
/// An ensemble of N coordinates, by a law of a dimension that is known at run time, whose start(seed, n) is
/// the start of trajectory n.
template <class Law, int N>
class in_dimension : public Law {
 public:
  using Law::Law;
  phase_point<double, N> operator()(std::uint64_t seed, std::uint64_t n) const {
    const phase_point<double, Eigen::Dynamic> x = this->start(seed, n);
    return {x.q, x.p};
  }
};

/// "q2 is nan": the first entry that is not finite; empty if there is none.
template <int N>
std::string not_finite_in(const phase_point<double, N>& x) {
  for (const auto& [name, values] : {std::pair('q', &x.q), std::pair('p', &x.p)}) {
    for (Eigen::Index i = 0; i < values->size(); ++i) {
      if (!std::isfinite((*values)[i])) return sentence("{}{} is {}", name, i + 1, (*values)[i]);
    }
  }
  return {};
}

template <System S, Ensemble<S> E>
phase_point<double, S::dimension> require_sound(const S& system, const E& ensemble, std::int64_t n,
                                                phase_point<double, S::dimension> start) {
  if (start.q.size() == size(system) && start.p.size() == size(system) && is_finite(start)) return start;
  const std::string what = not_finite_in(start);
  throw std::invalid_argument(sentence("start {} of {} must be finite and have the dimension of {}{}", n,
                                       ensemble.description(), describe(system),
                                       what.empty() ? "" : ": " + what));
}
}  // namespace detail

/// The start of trajectory n. Throws std::invalid_argument if it is not finite or does not fit.
template <System S, Ensemble<S> E>
phase_point<double, S::dimension> sound_start(const S& system, const E& ensemble, std::uint64_t seed,
                                              std::int64_t n) {
  return detail::require_sound(system, ensemble, n, ensemble(seed, static_cast<std::uint64_t>(n)));
}

namespace detail {

/// Initial states of `count` trajectories from the first on, one in each lane of T; lanes beyond them repeat
/// the first.
template <class T, System S, Ensemble<S> E>
phase_point<T, S::dimension> sound_starts(const S& system, const E& ensemble, std::uint64_t seed,
                                          std::int64_t first, int count) {
  const auto one_by_one = [&] {
    return detail::gather<T, S::dimension>(
        count, [&](int k) { return sound_start(system, ensemble, seed, first + k); });
  };
  if constexpr (MakesBlocks<E, S, T>) {
    if constexpr (requires { ensemble.makes_blocks(); }) {
      if (!ensemble.makes_blocks()) return one_by_one();
    }
    const auto all = ensemble.template block<T>(seed, first, count);
    return detail::gather<T, S::dimension>(
        count, [&](int k) { return detail::require_sound(system, ensemble, first + k, lane(all, k)); });
  } else {
    return one_by_one();
  }
}

}  // namespace detail

}  // namespace nysalt
