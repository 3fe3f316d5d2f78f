// SPDX-License-Identifier: BSL-1.0
// A word without its letters O: what it is in a bath that does not act.
#pragma once

#include <array>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "nysalt/run_time_word.hpp"

namespace nysalt {

namespace detail {

template <class Kept, class... L>
struct conservative;
template <class... Kept>
struct conservative<std::tuple<Kept...>> {
  static_assert(sizeof...(Kept) > 0, "nysalt: a word needs a letter beside those of the bath");
  using type = word<Kept...>;
};
template <class... Kept, class First, class... L>
struct conservative<std::tuple<Kept...>, First, L...>
    : std::conditional_t<StochasticFlow<First>, conservative<std::tuple<Kept...>, L...>,
                         conservative<std::tuple<Kept..., First>, L...>> {};

template <class W>
struct conservative_of;
template <class... L>
struct conservative_of<word<L...>> : conservative<std::tuple<>, L...> {};
template <>
struct conservative_of<run_time_word> {
  using type = run_time_word;
};

}  // namespace detail

/// The type of a word without its letters O; run_time_word is its own.
template <Word W>
using conservative_word = typename detail::conservative_of<W>::type;

/// The word without its letters O.
template <TypeLevelWord W>
conservative_word<W> conservative_part(const W&) {
  return {};
}
/// The same as data. Throws std::invalid_argument if nothing is left.
inline run_time_word conservative_part(const run_time_word& w) {
  std::string letters = w.letters();
  std::erase(letters, ornstein_uhlenbeck::letter);
  return w.with_letters(letters);
}

namespace detail {
/// Appends the coefficients of all letters but O.
inline void keep_conservative(const run_time_word& w, const auto& all, auto take) {
  for (std::size_t i = 0; i < w.length; ++i) {
    if (w.letters()[i] == ornstein_uhlenbeck::letter) continue;
    for (std::size_t k = 0; k < w.slots_of(i); ++k) take(all[w.first_slot(i) + k]);
  }
}
}  // namespace detail

/// The coefficients of the letters that are left, one for each of their slots.
template <TypeLevelWord W, class C>
typename conservative_word<W>::template coefficients<C> conservative_part(
    const W& w, const std::array<C, W::slots>& all) {
  if constexpr (W::stochastic_letters == 0) {
    return all;
  } else {
    typename conservative_word<W>::template coefficients<C> result;
    std::size_t kept = 0;
    detail::keep_conservative(run_time_word(w), all, [&](const C& c) { result[kept++] = c; });
    return result;
  }
}
/// The same as data. Throws std::invalid_argument unless there is a coefficient for each slot.
template <class C>
std::vector<C> conservative_part(const run_time_word& w, const std::vector<C>& all) {
  w.require_one_for_each_slot(all);
  if (w.stochastic_letters == 0) return all;
  std::vector<C> result;
  detail::keep_conservative(w, all, [&](const C& c) { result.push_back(c); });
  return result;
}

}  // namespace nysalt
