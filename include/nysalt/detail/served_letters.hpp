// SPDX-License-Identifier: BSL-1.0
// The letters of a word that a system serves.
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <utility>

#include "nysalt/detail/sentence.hpp"
#include "nysalt/run_time_word.hpp"

namespace nysalt {

namespace detail {
/// Does not compile, in the letter's words if it has some, unless a system serves it.
template <Flow L, System S, Scalar T>
constexpr void require_letter() {
  if constexpr (requires { L::template require_served<S, T>(); }) {
    L::template require_served<S, T>();
  } else {
    static_assert(L::template serves<S, T>, "nysalt: the system does not serve a letter of the word");
  }
}
template <System S, Scalar T, TypeLevelWord W, std::size_t... I>
constexpr void require_letters(std::index_sequence<I...>) {
  (require_letter<typename W::template letter<I>, S, T>(), ...);
}
}  // namespace detail

/// Whether a letter R is among them, so that modes are needed.
template <Word W>
bool has_rotation(const W& word) {
  return word.reads_modes;
}

/// Refuses a word with a letter that a system does not have over T. Where the word is a type it does not
/// compile. Throws std::invalid_argument, saying what is missing, where it is data.
template <System S, Scalar T, Word W>
void require_served(const W& word, const S& system) {
  if constexpr (TypeLevelWord<W>) {
    detail::require_letters<S, T, W>(std::make_index_sequence<W::length>{});
  } else {
    for (const char letter : word.letters()) {
      if (const auto* own = word.own_letter(letter)) {
        std::string base;
        if constexpr (ErasedSystem<S>) {
          base = system.facts().base_description;
        } else {
          base = describe(system);
        }
        if (own->system != base) {
          throw std::invalid_argument(
              sentence("the word {} must be made with the system {}, got the letter {} of {}; make the word "
                       "with this system",
                       word.letters(), base, letter, own->system));
        }
        if (!own->template serves<T>()) {
          throw std::invalid_argument(
              sentence("the word {} must step {} one trajectory at a time, as the letter {} has one lane",
                       word.letters(), describe(system), letter));
        }
      }
      detail::with_letter(letter, known_letters{}, [&](auto flow) {
        using L = decltype(flow);
        if constexpr (requires { L::needs; }) {
          bool is_served = L::template serves<S, T>;
          if constexpr (ErasedSystem<S>) is_served = system.facts().template serves<T>(letter);
          if (!is_served) {
            throw std::invalid_argument(
                sentence("cannot step {} by the word {}: {}", describe(system), word.letters(), L::needs));
          }
        }
      });
    }
  }
}

}  // namespace nysalt
