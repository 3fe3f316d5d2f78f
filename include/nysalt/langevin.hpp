// SPDX-License-Identifier: BSL-1.0
// Where the letters O go in a word that has none.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "nysalt/flows/ornstein_uhlenbeck.hpp"
#include "nysalt/run_time_word.hpp"

namespace nysalt {

/// Of a word S, over a whole step or two halves:
///   end        S O              [li_lu_tao_ye_2023, equation (2.13)]
///   symmetric  O/2 S O/2        one draw a step
///   middle     S with its central letter X split: ... X/2 O X/2 ...
enum class placement { end, symmetric, middle };

inline constexpr std::array placements{placement::end, placement::symmetric, placement::middle};

constexpr std::string_view to_string(placement p) {
  constexpr std::array<std::string_view, 3> names{"end", "symmetric", "middle"};
  return names[static_cast<std::size_t>(p)];
}

/// Of a word S of some order, where the bath damps alone: O commutes with S to first order only, and what is
/// symmetric has no second one.
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

/// Coefficients with those of the letters O: a container of any size, filled from one that is shorter.
template <class Result, class Coefficients>
Result thermostatted_coefficients(placement where, const Coefficients& c, Result result) {
  using C = typename Result::value_type;
  const std::size_t n = c.size();
  const std::size_t central = n / 2;
  switch (where) {
    case placement::end:
      for (std::size_t i = 0; i < n; ++i) result[i] = c[i];
      result[n] = C(1.0);
      return result;
    case placement::symmetric:
      result[0] = result[n + 1] = C(0.5);
      for (std::size_t i = 0; i < n; ++i) result[i + 1] = c[i];
      return result;
    case placement::middle:
      for (std::size_t i = 0; i < n; ++i) result[i < central ? i : i + 2] = c[i];
      result[central] = result[central + 2] = c[central] * 0.5;
      result[central + 1] = C(1.0);
      return result;
  }
  throw std::logic_error("thermostatted_coefficients: no such placement");
}

/// A word as data with its letters O. Throws std::invalid_argument if it has some already, or if it has no
/// central letter to split.
inline run_time_word thermostatted(const run_time_word& w, placement where) {
  const std::string& letters = w.letters();
  if (w.stochastic_letters > 0) {
    throw std::invalid_argument(fmt::format("the word {} has its letters O already", letters));
  }
  const std::string o(1, ornstein_uhlenbeck::letter);
  if (where == placement::end) return run_time_word(letters + o);
  if (where == placement::symmetric) return run_time_word(o + letters + o);
  if (letters.size() % 2 == 0) {
    throw std::invalid_argument(
        fmt::format("the word {} has no central letter to split: place O at the end, or symmetric", letters));
  }
  const std::size_t central = letters.size() / 2;
  return run_time_word(letters.substr(0, central + 1) + o + letters.substr(central));
}

}  // namespace nysalt
