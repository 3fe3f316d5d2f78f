// SPDX-License-Identifier: BSL-1.0
// A method's letters in the order in which they act, and what follows from that order alone.
#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <numeric>
#include <string>
#include <tuple>
#include <type_traits>

#include "nysalt/flow.hpp"

namespace nysalt {

/// What a letter does about force(q) before it acts: nothing, as it does not read it or finds it at hand; or
/// it evaluates it, for itself alone, so that it need not be stored, or for later letters too.
enum class evaluation { none, unshared, shared };

namespace detail {

/// The evaluations of all letters, known at compile time or at run time: an array or a vector of evaluations.
template <class Evaluations>
struct evaluation_plan {
  Evaluations in_step;              // a plain step, which starts from q and p alone
  Evaluations in_loop;              // a step of an open run, if another one follows; from letter `first` on
  Evaluations in_last;              // the same, if the run may be looked at then
  bool is_known_when_open = false;  // the force, whenever a run may be looked at

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
  /// Whoever does not find the force known evaluates it. Returns whether it is known after the last letter.
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
  static constexpr std::size_t length = sizeof...(L);  ///< how many letters
  /// The flow of letter I, from 0 on.
  template <std::size_t I>
  using letter = std::tuple_element_t<I, std::tuple<L...>>;
  /// One for each slot; C is double or the scalar of the states.
  template <class C>
  using coefficients = std::array<C, (0 + ... + L::slots)>;

  /// Where the coefficients of letter i begin; those of all letters stand one after the other.
  static constexpr std::size_t first_slot(std::size_t i) {
    constexpr std::array<std::size_t, length> slots{L::slots...};
    return std::accumulate(slots.begin(), slots.begin() + static_cast<std::ptrdiff_t>(i), std::size_t{0});
  }
  static constexpr std::size_t slots = first_slot(length);  ///< how many coefficients

  /// The force that its letters read.
  static constexpr field reads = std::max({L::reads...});
  /// One of its letters is of this splitting of H alone.
  static constexpr bool holds(splitting of_h) { return ((detail::splitting_of<L>() == of_h) || ...); }
  /// Its letters are those of a quadratic part and the rest, R, S or H.
  static constexpr bool rotates() { return holds(splitting::quadratic_part_and_rest); }
  /// Its letters are of one splitting of H. Others do not compile.
  static constexpr bool has_one_splitting = !(holds(splitting::kinetic_and_potential) && rotates());
  static_assert(
      has_one_splitting,
      "nysalt: the letters A, B, D, G split H into K and V, and R, S, H into its quadratic part and the "
      "rest: a word has those of one splitting");

  static constexpr bool reads_modes = (QuadraticFlow<L> || ...);  ///< it has a letter R

  /// Last and first letter of successive steps are applied as one.
  static constexpr bool merges = [] {
    return length > 1 && std::is_same_v<letter<0>, letter<length - 1>> && letter<0>::additive;
  }();

  /// How many letters of the bath there are.
  static constexpr int stochastic_letters = (0 + ... + (StochasticFlow<L> ? 1 : 0));
  /// Which of the letters of the bath letter i is, from 0 on: how many come before it.
  static constexpr int stochastic_number(std::size_t i) {
    constexpr std::array<bool, length> is{StochasticFlow<L>...};
    return static_cast<int>(std::count(is.begin(), is.begin() + static_cast<std::ptrdiff_t>(i), true));
  }
  /// A letter of the bath ends one step, and another begins the next.
  static constexpr bool merges_half_steps =
      length > 1 && StochasticFlow<letter<0>>&& StochasticFlow<letter<length - 1>>;

  static std::string letters() { return {L::letter...}; }  ///< as in docs/notation.md, from left to right

  /// Where a step of an open run begins: 1 if letter 0 merges with the last.
  static constexpr std::size_t first_in_loop = merges ? 1 : 0;
  /// Which letters evaluate the force, in a plain step and in an open run.
  static constexpr detail::evaluation_plan<std::array<evaluation, length>> plan{
      std::array{(L::reads != field::none)...}, std::array{L::moves_q...}, first_in_loop, {}};

  /// How many f'(q) v a step evaluates, each of which counts as one force evaluation.
  static constexpr int force_derivatives =
      (0 + ... + L::force_derivatives);  // none is in a letter that merges
  /// How many forces its letters evaluate themselves in a plain step, at displaced points or of parts.
  static constexpr int displaced_forces = (0 + ... + detail::displaced_forces_of<L>());
  /// Those of the first letter where it merges: once a run, and not in each step of it.
  static constexpr int displaced_forces_to_open = merges ? detail::displaced_forces_of<letter<0>>() : 0;
  /// Each of its letters is symplectic, and so is the step.
  static constexpr bool is_symplectic = (detail::is_symplectic<L>() && ...);
  /// Force evaluations of a step of an open run.
  static constexpr int evaluations_per_step =
      plan.count(plan.in_loop) + force_derivatives + displaced_forces - displaced_forces_to_open;
  /// Those to open a run.
  static constexpr int evaluations_to_open = (plan.is_known_when_open ? 1 : 0) + displaced_forces_to_open;
  /// Those each time that a run is looked at: of the first letter, which is taken back on a copy.
  static constexpr int evaluations_to_observe = displaced_forces_to_open;
  /// Those of a plain step, which begins with q and p alone.
  static constexpr int evaluations_of_plain_step =
      plan.count(plan.in_step) + force_derivatives + displaced_forces;
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
