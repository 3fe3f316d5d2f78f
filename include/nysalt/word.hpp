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
template <std::size_t Length>
constexpr bool track_force(const std::array<bool, Length>& reads, const std::array<bool, Length>& moves,
                           std::array<bool, Length>& known, std::size_t first, bool now) {
  for (std::size_t i = first; i < Length; ++i) {
    known[i] = now;
    now = (now || reads[i]) && !moves[i];
  }
  return now;
}

template <std::size_t Length>
constexpr int count_evaluations(const std::array<bool, Length>& reads, const std::array<bool, Length>& known,
                                std::size_t first) {
  int count = 0;
  for (std::size_t i = first; i < Length; ++i) count += reads[i] && !known[i];
  return count;
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

  /// Last and first letter of successive steps are applied as one.
  static constexpr bool merges =
      length > 1 && std::is_same_v<letter<0>, letter<length - 1>>&& letter<0>::additive;

  static std::string letters() { return {L::letter...}; }

  /// force(q) is at hand before each letter of a plain step, which starts from q and p alone.
  static constexpr std::array<bool, length> known_in_step = [] {
    std::array<bool, length> known{};
    detail::track_force<length>({L::reads_force...}, {L::moves_q...}, known, 0, false);
    return known;
  }();

  /// The same before each letter of the loop, from first_in_loop on, in the steady state.
  static constexpr std::size_t first_in_loop = merges ? 1 : 0;
  static constexpr std::array<bool, length> known_in_loop = [] {
    constexpr std::array<bool, length> reads{L::reads_force...};
    constexpr std::array<bool, length> moves{L::moves_q...};
    std::array<bool, length> known{};
    const bool after_one_step = detail::track_force(reads, moves, known, first_in_loop, false);
    detail::track_force(reads, moves, known, first_in_loop, after_one_step);
    return known;
  }();

  /// Force evaluations of one step in the loop, of opening a run, and of a plain step.
  static constexpr int evaluations_per_step =
      detail::count_evaluations<length>({L::reads_force...}, known_in_loop, first_in_loop);
  static constexpr int evaluations_to_open = [] {
    constexpr std::array<bool, length> reads{L::reads_force...};
    constexpr std::array<bool, length> moves{L::moves_q...};
    if (merges && reads[0]) return 1;
    for (std::size_t i = first_in_loop; i < length; ++i) {
      if (reads[i]) return known_in_loop[i] ? 1 : 0;
      if (moves[i]) return 0;  // what was known is stale before it is read
    }
    return 0;
  }();
  static constexpr int evaluations_of_plain_step =
      detail::count_evaluations<length>({L::reads_force...}, known_in_step, 0);
};

namespace detail {
template <class W>
inline constexpr bool is_word = false;
template <class... L>
inline constexpr bool is_word<word<L...>> = true;
}  // namespace detail

template <class W>
concept Word = detail::is_word<W>;

}  // namespace nysalt
