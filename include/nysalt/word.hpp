// SPDX-License-Identifier: BSL-1.0
// A method's letters in the order in which they act, and what follows from that order alone.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <string>
#include <tuple>
#include <type_traits>

#include "nysalt/flow.hpp"

namespace nysalt {

namespace detail {

/// Marks where force(q) is at hand before each letter from `first` on, and says whether it is after the last.
/// Works on the facts of letters known at compile time and at run time alike.
constexpr bool track_force(const auto& reads, const auto& moves, auto& known, std::size_t first, bool now) {
  for (std::size_t i = first; i < reads.size(); ++i) {
    known[i] = now;
    now = (now || reads[i]) && !moves[i];
  }
  return now;
}

/// The same in a loop over letters first..last that has been gone round before.
constexpr void track_force_in_loop(const auto& reads, const auto& moves, auto& known, std::size_t first) {
  const bool after_one_step = track_force(reads, moves, known, first, false);
  track_force(reads, moves, known, first, after_one_step);
}

constexpr int count_evaluations(const auto& reads, const auto& known, std::size_t first) {
  int count = 0;
  for (std::size_t i = first; i < reads.size(); ++i) count += reads[i] && !known[i];
  return count;
}

/// Whether the loop's first reader of the force finds it known, so that opening a run must provide it.
constexpr int count_evaluations_to_open(const auto& reads, const auto& moves, const auto& known,
                                        std::size_t first) {
  if (first > 0 && reads[0]) return 1;  // the first letter itself is applied then
  for (std::size_t i = first; i < reads.size(); ++i) {
    if (reads[i]) return known[i] ? 1 : 0;
    if (moves[i]) return 0;  // what was known is stale before it is read
  }
  return 0;
}

}  // namespace detail

/// Letters act from left to right: word<kick, drift, kick> is velocity Verlet.
///
/// A run over many steps is held open: the first letter is already applied. Where the last letter is the
/// first one again (and additive), the two become one; and a force is reused while q has not moved.
/// Both are known here, at compile time, and so is the number of force evaluations.
template <Flow... L>
  requires(sizeof...(L) > 0)
struct word {
  static constexpr std::size_t length = sizeof...(L);
  template <std::size_t I>
  using letter = std::tuple_element_t<I, std::tuple<L...>>;
  template <class C>
  using coefficients = std::array<C, length>;

  /// Last and first letter of successive steps are applied as one.
  static constexpr bool merges =
      length > 1 && std::is_same_v<letter<0>, letter<length - 1>>&& letter<0>::additive;

  static std::string letters() { return {L::letter...}; }

  static constexpr std::array<bool, length> reads{L::reads_force...};
  static constexpr std::array<bool, length> moves{L::moves_q...};

  /// force(q) is at hand before each letter of a plain step, which starts from q and p alone.
  static constexpr std::array<bool, length> known_in_step = [] {
    std::array<bool, length> known{};
    detail::track_force(reads, moves, known, 0, false);
    return known;
  }();

  /// The same before each letter of the loop, from first_in_loop on, in the steady state.
  static constexpr std::size_t first_in_loop = merges ? 1 : 0;
  static constexpr std::array<bool, length> known_in_loop = [] {
    std::array<bool, length> known{};
    detail::track_force_in_loop(reads, moves, known, first_in_loop);
    return known;
  }();

  /// Force evaluations of one step in the loop, of opening a run, and of a plain step.
  static constexpr int evaluations_per_step = detail::count_evaluations(reads, known_in_loop, first_in_loop);
  static constexpr int evaluations_to_open =
      detail::count_evaluations_to_open(reads, moves, known_in_loop, first_in_loop);
  static constexpr int evaluations_of_plain_step = detail::count_evaluations(reads, known_in_step, 0);
};

namespace detail {
template <class W>
inline constexpr bool is_word = false;
template <class... L>
inline constexpr bool is_word<word<L...>> = true;
}  // namespace detail

/// Letters known at compile time: what a family's coefficients are for. Beside it stands run_time_word.
template <class W>
concept TypeLevelWord = detail::is_word<W>;

}  // namespace nysalt
