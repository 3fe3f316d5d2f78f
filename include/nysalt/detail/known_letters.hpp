// SPDX-License-Identifier: BSL-1.0
// The letters that a word as data can name, and those of one's own that it carries.
#pragma once

#include <concepts>
#include <cstddef>
#include <memory>
#include <stdexcept>
#include <tuple>
#include <type_traits>
#include <typeinfo>
#include <utility>
#include <vector>

#include "nysalt/detail/own_letter.hpp"
#include "nysalt/detail/sentence.hpp"
#include "nysalt/flows/drift_kick.hpp"
#include "nysalt/flows/gradient_kick.hpp"
#include "nysalt/flows/ornstein_uhlenbeck.hpp"
#include "nysalt/flows/rotation.hpp"
#include "nysalt/word.hpp"

namespace nysalt {

/// Every flow that a word can name by its letter at run time: what is said of letters elsewhere is asked of
/// these.
using known_letters = std::tuple<drift, kick, gradient_kick, displaced_kick, rotation, soft_kick,
                                 soft_gradient_kick, ornstein_uhlenbeck>;

namespace detail {
/// f(flow) for the flow of that letter among the given ones; false if there is none.
template <class... L>
[[gnu::always_inline]] inline bool with_letter(char letter, std::tuple<L...>, auto&& f) {
  return ((L::letter == letter && (f(L{}), true)) || ...);
}

template <class L, class Known>
inline constexpr bool is_among = false;
template <class L, class... Known>
inline constexpr bool is_among<L, std::tuple<Known...>> = (std::same_as<L, Known> || ...);
/// One of known_letters.
template <class L>
inline constexpr bool is_known_letter = is_among<L, known_letters>;

template <class L, class Known>
inline constexpr bool is_named_among = false;
template <class L, class... Known>
inline constexpr bool is_named_among<L, std::tuple<Known...>> = ((L::letter == Known::letter) || ...);
/// Its character is that of one of known_letters.
template <class L>
inline constexpr bool names_known_letter = is_named_among<L, known_letters>;
}  // namespace detail

/// Whether all letters of a word are of known_letters, so that it can be data without a system.
template <TypeLevelWord W>
consteval bool are_known_letters() {
  return []<std::size_t... I>(std::index_sequence<I...>) {
    return (detail::is_known_letter<typename W::template letter<I>> && ...);
  }(std::make_index_sequence<W::length>());
}

namespace detail {

using own_letters = std::vector<std::shared_ptr<const own_letter>>;

/// The letters of one's own of a word, as they act on a system. Throws std::invalid_argument if two of them
/// have one name.
template <TypeLevelWord W, System S>
own_letters bound_letters(const S& system) {
  own_letters result;
  std::vector<const std::type_info*> types;
  const auto add = [&]<class L>(std::type_identity<L>) {
    if constexpr (!is_known_letter<L>) {
      static_assert(!names_known_letter<L>,
                    "nysalt: a letter of one's own takes a character that no known letter has");
      for (std::size_t k = 0; k < result.size(); ++k) {
        if (result[k]->facts.letter != L::letter) continue;
        if (*types[k] == typeid(L)) return;
        throw std::invalid_argument(
            sentence("the word {}: letters of one's own must have different names, got {} twice; name one of "
                     "them otherwise",
                     W::letters(), L::letter));
      }
      types.push_back(&typeid(L));
      result.push_back(std::make_shared<const bound_letter<L, S>>(system));
    }
  };
  [&]<std::size_t... I>(std::index_sequence<I...>) {
    (add(std::type_identity<typename W::template letter<I>>()), ...);
  }(std::make_index_sequence<W::length>());
  return result;
}

}  // namespace detail

}  // namespace nysalt
