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

template <Word W>
using conservative_word = typename detail::conservative_of<W>::type;

template <TypeLevelWord W>
conservative_word<W> conservative_part(const W&) {
  return {};
}
/// Throws std::invalid_argument if nothing is left.
inline run_time_word conservative_part(const run_time_word& w) {
  std::string letters = w.letters();
  std::erase(letters, ornstein_uhlenbeck::letter);
  return run_time_word(letters);
}

template <TypeLevelWord W, class C>
std::array<C, conservative_word<W>::length> conservative_part(const W&, const std::array<C, W::length>& all) {
  const std::string letters = W::letters();
  std::array<C, conservative_word<W>::length> result;
  for (std::size_t i = 0, kept = 0; i < all.size(); ++i) {
    if (letters[i] != ornstein_uhlenbeck::letter) result[kept++] = all[i];
  }
  return result;
}
/// Throws std::invalid_argument unless there is a coefficient for each letter.
template <class C>
std::vector<C> conservative_part(const run_time_word& w, const std::vector<C>& all) {
  w.require_one_for_each_letter(all);
  std::vector<C> result;
  for (std::size_t i = 0; i < w.length; ++i) {
    if (w.letters()[i] != ornstein_uhlenbeck::letter) result.push_back(all[i]);
  }
  return result;
}

}  // namespace nysalt
