// SPDX-License-Identifier: BSL-1.0
// A method's letters in the order in which they act, and what follows from that order.
#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <numeric>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>

#include "nysalt/flow.hpp"

namespace nysalt {

/// Evaluation of force(q) before a letter acts: none, where the letter does not read the force or finds the
/// force known; unshared, for this letter only, so that the force need not be stored; or shared with later
/// letters.
enum class evaluation { none, unshared, shared };

namespace detail {

/// The evaluations of all letters, known at compile time or at run time: an array or a vector of evaluations.
template <class Evaluations>
struct evaluation_plan {
  Evaluations in_step;              // a plain step, which starts from only q and p
  Evaluations in_loop;              // a step of an open run, if another one follows; from letter `first` on
  Evaluations in_last;              // the same, if the run may be observed then
  bool is_known_when_open = false;  // the force, whenever a run may be observed

  constexpr evaluation_plan() = default;
  /// reads[i]: letter i reads the force; moves[i]: it is stale afterwards.
  constexpr evaluation_plan(const auto& reads, const auto& moves, std::size_t first, const Evaluations& none)
      : in_step(none), in_loop(none) {
    find_known(reads, moves, in_step, 0, false);
    find_needed(reads, in_step, 0, false);
    const bool after_one_step = find_known(reads, moves, in_loop, first, false);
    find_known(reads, moves, in_loop, first, after_one_step);
    const bool by_next = find_needed(reads, in_loop, first, false);
    in_last = in_loop;
    is_known_when_open = by_next || (first > 0 && reads[0]);  // the first letter may be taken back
    find_needed(reads, in_loop, first, by_next);
    find_needed(reads, in_last, first, is_known_when_open);
  }

  static constexpr int count(const Evaluations& found) {
    int result = 0;
    for (const evaluation e : found) result += e != evaluation::none;
    return result;
  }

 private:
  /// A letter that does not find the force known evaluates it. Returns whether it is known after the last
  /// letter.
  static constexpr bool find_known(const auto& reads, const auto& moves, Evaluations& found,
                                   std::size_t first, bool known) {
    for (std::size_t i = first; i < reads.size(); ++i) {
      found[i] = reads[i] && !known ? evaluation::shared : evaluation::none;
      known = (known || reads[i]) && !moves[i];
    }
    return known;
  }

  /// Who evaluates it for others, if it is needed after the last letter or not. Returns whether it is needed
  /// before the first.
  static constexpr bool find_needed(const auto& reads, Evaluations& found, std::size_t first, bool needed) {
    for (std::size_t i = reads.size(); i-- > first;) {
      if (!reads[i]) continue;
      if (found[i] != evaluation::none) found[i] = needed ? evaluation::shared : evaluation::unshared;
      needed = found[i] == evaluation::none;
    }
    return needed;
  }
};

}  // namespace detail

/// A method by its letters, as a type. They act from left to right: word<kick, drift, kick> is velocity
/// Verlet.
///
/// A run over many steps is held open: the first letter is already applied. Where the last letter is the
/// first one again (and additive), the two become one; and a force is reused while q has not moved.
/// Both are known here, at compile time, and so is the number of force evaluations.
template <Flow... L>
  requires(sizeof...(L) > 0)
struct word {
  static constexpr std::size_t length = sizeof...(L);  ///< number of letters
  /// The flow of letter I, from 0 on.
  template <std::size_t I>
  using letter = std::tuple_element_t<I, std::tuple<L...>>;
  /// Coefficients, one for each slot; C is double or the scalar of the states.
  template <class C>
  using coefficients = std::array<C, (0 + ... + L::slots)>;

  /// Index of the first coefficient of letter i; those of all letters are in one list, letter after letter.
  static constexpr std::size_t first_slot(std::size_t i) {
    constexpr std::array<std::size_t, length> slots{L::slots...};
    return std::accumulate(slots.begin(), slots.begin() + static_cast<std::ptrdiff_t>(i), std::size_t{0});
  }
  static constexpr std::size_t slots = first_slot(length);  ///< number of coefficients

  /// The force that its letters read.
  static constexpr field reads = std::max({L::reads...});
  /// Whether a letter belongs to this splitting of H only.
  static constexpr bool holds(splitting of_h) { return ((detail::splitting_of<L>() == of_h) || ...); }
  /// Whether the letters are those of a quadratic part and the rest, R, S or H.
  static constexpr bool rotates() { return holds(splitting::quadratic_part_and_rest); }
  /// Whether all letters are of one splitting of H. Others do not compile.
  static constexpr bool has_one_splitting = !(holds(splitting::kinetic_and_potential) && rotates());
  static_assert(
      has_one_splitting,
      "nysalt: the letters A, B, D, G split H into K and V, and R, S, H into its quadratic part and the "
      "rest: a word has those of one splitting");

  static constexpr bool reads_modes = (QuadraticFlow<L> || ...);  ///< whether the word has a letter R

  /// Last and first letter of successive steps are applied as one.
  static constexpr bool merges = [] {
    return length > 1 && std::is_same_v<letter<0>, letter<length - 1>> && letter<0>::additive;
  }();

  /// Number of letters O.
  static constexpr int stochastic_letters = (0 + ... + (StochasticFlow<L> ? 1 : 0));
  /// Number of letter i among the letters O, from 0 on.
  static constexpr int stochastic_number(std::size_t i) {
    constexpr std::array<bool, length> is{StochasticFlow<L>...};
    return static_cast<int>(std::count(is.begin(), is.begin() + static_cast<std::ptrdiff_t>(i), true));
  }
  /// A letter of the bath ends one step, and another begins the next.
  static constexpr bool merges_half_steps =
      length > 1 && StochasticFlow<letter<0>>&& StochasticFlow<letter<length - 1>>;

  static std::string letters() {
    return {L::letter...};
  }  ///< letters of docs/notation.md, from left to right

  /// First letter of a step of an open run: 1 if letter 0 merges with the last.
  static constexpr std::size_t first_in_loop = merges ? 1 : 0;
  /// Plan of force evaluations, in a plain step and in an open run.
  static constexpr detail::evaluation_plan<std::array<evaluation, length>> plan{
      std::array{(L::reads != field::none)...}, std::array{L::moves_q...}, first_in_loop, {}};

  /// Number of f'(q) v in a step, each of which counts as one force evaluation.
  static constexpr int force_derivatives =
      (0 + ... + L::force_derivatives);  // none is in a letter that merges
  /// Number of forces that letters evaluate themselves in a plain step, at displaced points or of parts.
  static constexpr int displaced_forces = (0 + ... + detail::displaced_forces_of<L>());
  /// Forces of the first letter where it merges: once a run, not in each step.
  static constexpr int displaced_forces_to_open = merges ? detail::displaced_forces_of<letter<0>>() : 0;
  /// Whether every letter is symplectic, and so the step.
  static constexpr bool is_symplectic = (detail::is_symplectic<L>() && ...);
  /// Force evaluations of a step of an open run.
  static constexpr int evaluations_per_step =
      plan.count(plan.in_loop) + force_derivatives + displaced_forces - displaced_forces_to_open;
  /// Force evaluations to open a run.
  static constexpr int evaluations_to_open = (plan.is_known_when_open ? 1 : 0) + displaced_forces_to_open;
  /// Force evaluations of an observation: those of the first letter, which is taken back on a copy.
  static constexpr int evaluations_to_observe = displaced_forces_to_open;
  /// Force evaluations of a plain step, which begins with only q and p.
  static constexpr int evaluations_of_plain_step =
      plan.count(plan.in_step) + force_derivatives + displaced_forces;
};

namespace detail {
template <class W>
inline constexpr bool is_word = false;
template <class... L>
inline constexpr bool is_word<word<L...>> = true;
}  // namespace detail

/// Letters known at compile time: the word of a family as a type. The word as data is run_time_word.
template <class W>
concept TypeLevelWord = detail::is_word<W>;

// Words of two letters in turn that read the same from both ends.

namespace detail {
template <Flow First, Flow Second, std::size_t... I>
auto alternate(std::index_sequence<I...>) -> word<std::conditional_t<I % 2 == 0, First, Second>...>;
}  // namespace detail

/// First Second First ... of the given odd length.
template <Flow First, Flow Second, std::size_t Length>
  requires(Length % 2 == 1)
using alternating_word = decltype(detail::alternate<First, Second>(std::make_index_sequence<Length>{}));

/// The coefficients x_1 y_1 x_2 y_2 ... y_2 x_2 y_1 x_1 of such a word from its first ones: the middle one
/// and its neighbour follow from consistency, sum x = sum y = 1. Symmetric, hence of even order.
template <std::size_t Length, class C = double>
  requires(Length % 2 == 1 && Length >= 3)
constexpr std::array<C, Length> palindrome(const std::array<C, (Length - 3) / 2>& free) {
  constexpr std::size_t middle = (Length - 1) / 2;
  std::array<C, Length> all{};
  C of_middle_letter(1.0);
  C of_neighbour(0.5);
  for (std::size_t i = 0; i + 1 < middle; ++i) {
    all[i] = free[i];
    if (i % 2 == middle % 2) {
      of_middle_letter = of_middle_letter - 2.0 * free[i];
    } else {
      of_neighbour = of_neighbour - free[i];
    }
  }
  all[middle - 1] = of_neighbour;
  all[middle] = of_middle_letter;
  for (std::size_t i = 0; i < middle; ++i) all[Length - 1 - i] = all[i];
  return all;
}

}  // namespace nysalt
