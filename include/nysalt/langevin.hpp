// SPDX-License-Identifier: BSL-1.0
// Placements of the letters O in a word that has none.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "nysalt/detail/sentence.hpp"
#include "nysalt/flows/ornstein_uhlenbeck.hpp"
#include "nysalt/noise.hpp"
#include "nysalt/run_time_word.hpp"

namespace nysalt {

/// Placement of letters O in a thermostatted word S, over a whole step or two halves:
///   end        S O              [li_lu_tao_ye_2023, equation (2.13)]
///   symmetric  O/2 S O/2        one draw a step
///   middle     S with its central letter X split: ... X/2 O X/2 ...
enum class placement { end, symmetric, middle };

/// All placements, in that order.
inline constexpr std::array placements{placement::end, placement::symmetric, placement::middle};

/// Name of a placement in programs and files: end, symmetric or middle.
constexpr std::string_view to_string(placement p) {
  constexpr std::array<std::string_view, 3> names{"end", "symmetric", "middle"};
  return names[static_cast<std::size_t>(p)];
}

/// The order of a word S with letters O where the bath has no noise (sigma = 0): 1 where O is at the end,
/// or in the middle of what is not symmetric; else at most 2, as O and S do not commute.
constexpr int thermostatted_order(placement p, int order, bool symmetric) {
  const bool is_first = p == placement::end || (p == placement::middle && !symmetric);
  return is_first ? 1 : std::min(order, 2);
}

namespace detail {

template <placement P, TypeLevelWord W, class Positions>
struct thermostatted_letters;
template <class... L, std::size_t... I>
struct thermostatted_letters<placement::end, word<L...>, std::index_sequence<I...>> {
  using type = word<L..., ornstein_uhlenbeck>;
};
template <class... L, std::size_t... I>
struct thermostatted_letters<placement::symmetric, word<L...>, std::index_sequence<I...>> {
  using type = word<ornstein_uhlenbeck, L..., ornstein_uhlenbeck>;
};
template <class... L, std::size_t... I>
struct thermostatted_letters<placement::middle, word<L...>, std::index_sequence<I...>> {
  using W = word<L...>;
  static_assert(W::length % 2 == 1,
                "nysalt: a word with an even number of letters has no central letter to split");
  static constexpr std::size_t central = W::length / 2;
  template <std::size_t K>
  using letter = typename W::template letter<(K <= central + 1 ? std::min(K, central) : K - 2)>;
  using type = word<std::conditional_t<I == central + 1, ornstein_uhlenbeck, letter<I>>...>;
};

template <TypeLevelWord W, placement P>
struct thermostatted_type {
  static_assert(W::stochastic_letters == 0, "nysalt: this word has its letters O already");
  using type = typename thermostatted_letters<P, W, std::make_index_sequence<W::length + 2>>::type;
};

}  // namespace detail

/// The word of type W with its letters O.
template <TypeLevelWord W, placement P>
using thermostatted_word = typename detail::thermostatted_type<W, P>::type;

namespace detail {
/// The coefficients of a word with those of its letters O, in the order of the word: take(c) for each. The
/// central letter has those from `first` to `end`.
void with_those_of_bath(placement where, const auto& c, std::size_t first, std::size_t end, auto take) {
  using C = std::remove_cvref_t<decltype(c[0])>;
  if (where == placement::symmetric) take(C(0.5));
  for (std::size_t i = 0; i < c.size(); ++i) {
    const bool is_split = where == placement::middle && first <= i && i < end;
    take(is_split ? C(c[i] * 0.5) : c[i]);
    if (!is_split || i + 1 < end) continue;
    take(C(1.0));
    for (std::size_t k = first; k < end; ++k) take(C(c[k] * 0.5));
  }
  if (where == placement::symmetric) take(C(0.5));
  if (where == placement::end) take(C(1.0));
}
}  // namespace detail

/// Coefficients with those of the letters O, for the word of type Result with its letters O.
template <TypeLevelWord Result, class C, std::size_t Slots>
typename Result::template coefficients<C> thermostatted_coefficients(placement where,
                                                                     const std::array<C, Slots>& c) {
  constexpr std::size_t central = (Result::length - 2) / 2;  // of the word that is split, with O two longer
  typename Result::template coefficients<C> result;
  std::size_t filled = 0;
  detail::with_those_of_bath(where, c, Result::first_slot(central), Result::first_slot(central + 1),
                             [&](const C& one) { result[filled++] = one; });
  return result;
}

/// Coefficients as data, for the word without its letters O.
template <class C>
std::vector<C> thermostatted_coefficients(const run_time_word& w, placement where, const std::vector<C>& c) {
  const std::size_t central = w.length / 2;
  std::vector<C> result;
  detail::with_those_of_bath(where, c, w.first_slot(central), w.first_slot(central) + w.slots_of(central),
                             [&](const C& one) { result.push_back(one); });
  return result;
}

/// Intervals of a step that the letters O of a word cover. Throws std::invalid_argument unless they share it
/// as noise_intervals.hpp says.
inline noise_intervals intervals_of_noise(const run_time_word& word, const auto& coefficients) {
  std::vector<double> of_bath;
  for (std::size_t i = 0; i < word.length; ++i) {
    if (word.letters()[i] == bath_letter) of_bath.push_back(coefficients[word.first_slot(i)]);
  }
  return intervals_of_noise(word.letters(), of_bath);
}
template <TypeLevelWord W>
noise_intervals intervals_of_noise(const W& word, const auto& coefficients) {
  return intervals_of_noise(run_time_word(word), coefficients);
}

/// A word as data with its letters O. Throws std::invalid_argument if it has some already, if it has no
/// central letter to split, or if it is processed: only the kernel decides the temperature of a mode, as a
/// processor changes no action, and a kernel that was learned with a processor may have any.
inline run_time_word thermostatted(const run_time_word& w, placement where) {
  const std::string& letters = w.letters();
  if (w.stochastic_letters > 0) {
    throw std::invalid_argument(sentence("thermostat: the word must have no letters O, got {}", letters));
  }
  if (w.is_processed()) {
    throw std::invalid_argument(
        sentence("thermostat: the word in a bath must have no processor, got {}; take one without, as a "
                 "kernel that is made for a processor gives modes another temperature",
                 letters));
  }
  const std::string o(1, ornstein_uhlenbeck::letter);
  if (where == placement::end) return w.with_letters(letters + o);
  if (where == placement::symmetric) return w.with_letters(o + letters + o);
  if (letters.size() % 2 == 0) {
    throw std::invalid_argument(
        sentence("thermostat: the word must have a central letter to split, got {}; place O at the "
                 "end, or symmetric",
                 letters));
  }
  const std::size_t central = letters.size() / 2;
  return w.with_letters(letters.substr(0, central + 1) + o + letters.substr(central));
}

}  // namespace nysalt
