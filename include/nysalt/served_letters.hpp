// SPDX-License-Identifier: BSL-1.0
// Which letters of a word a system has.
#pragma once

#include <cstddef>
#include <stdexcept>
#include <utility>

#include "nysalt/run_time_word.hpp"
#include "nysalt/sentence.hpp"

namespace nysalt {

namespace detail {
constexpr const char* needs_quadratic_part =
    "the letters R, S, H need a system that declares a quadratic part: modes() and soft_force(q, f), see "
    "nysalt/system.hpp, or with_quadratic_part(system, stiffness); as templates over any scalar, where they "
    "are "
    "learned or H is among them";
constexpr const char* needs_quadratic_kinetic =
    "the letter G needs a quadratic kinetic energy, and a force that can be differentiated";

template <System S, Scalar T, TypeLevelWord W, std::size_t... I>
consteval bool serves_all(std::index_sequence<I...>) {
  return (W::template letter<I>::template serves<S, T> && ...);
}
}  // namespace detail

/// Whether a letter R is among them, so that modes are needed.
template <Word W>
bool has_rotation(const W& word) {
  return word.letters().find(rotation::letter) != std::string::npos;
}

/// Refuses a word with a letter that a system does not have over T. Where the word is a type it does not
/// compile. Throws std::invalid_argument, saying what is missing, where it is data.
template <System S, Scalar T, Word W>
void require_served(const W& word, const S& system) {
  if constexpr (TypeLevelWord<W>) {
    constexpr bool is_served = detail::serves_all<S, T, W>(std::make_index_sequence<W::length>{});
    static_assert(is_served || W::reads != field::whole,
                  "nysalt: the letter G needs a quadratic kinetic energy, and a force that can be "
                  "differentiated");
    static_assert(is_served || W::reads == field::whole,
                  "nysalt: the letters R, S, H need a system that declares a quadratic part: modes() and "
                  "soft_force(q, f), see nysalt/system.hpp");
  } else {
    for (const char letter : word.letters()) {
      if constexpr (ErasedSystem<S>) {
        const auto& served = system.facts().template over<T>();
        const bool is_served = letter == rotation::letter             ? served.R
                               : letter == soft_kick::letter          ? served.S
                               : letter == gradient_kick::letter      ? served.G
                               : letter == soft_gradient_kick::letter ? served.H
                                                                      : true;
        if (is_served) continue;
        throw std::invalid_argument(
            sentence("the word {} cannot step {}: {}", word.letters(), describe(system),
                     letter == gradient_kick::letter ? detail::needs_quadratic_kinetic
                                                     : detail::needs_quadratic_part));
      }
      detail::with_letter(letter, known_letters{}, [&](auto flow) {
        using L = decltype(flow);
        if constexpr (!L::template serves<S, T>) {
          throw std::invalid_argument(
              sentence("the word {} cannot step {}: {}", word.letters(), describe(system),
                       letter == gradient_kick::letter ? detail::needs_quadratic_kinetic
                                                       : detail::needs_quadratic_part));
        }
      });
    }
  }
}

}  // namespace nysalt
