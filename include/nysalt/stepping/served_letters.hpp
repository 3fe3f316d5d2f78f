// SPDX-License-Identifier: BSL-1.0
// The letters of a word that a system serves.
#pragma once

#include <algorithm>
#include <stdexcept>
#include <string_view>

#include "nysalt/core/sentence.hpp"
#include "nysalt/stepping/system_letters.hpp"
#include "nysalt/word.hpp"

namespace nysalt::detail {

/// Refuses a letter that is not the library's, unless the system declares it.
template <class T, class S>
void require_declared(const word& letters, const letter_facts& own, const S& system) {
  const letters_on has(system);
  const auto& declared = has.declared();
  if (std::ranges::find(declared, own) == declared.end()) {
    throw std::invalid_argument(
        sentence("cannot step {} by the word {}: the system must declare the letter {}; add it to `using "
                 "letters = std::tuple<...>` of the system, or take with_letters",
                 describe(system), letters.letters(), own.letter));
  }
  if (!has.template serves<T>(own.letter)) {
    throw std::invalid_argument(sentence("cannot step {} by the word {}: the letter {} must serve the system",
                                         describe(system), letters.letters(), own.letter));
  }
}

}  // namespace nysalt::detail

namespace nysalt {

/// Throws std::invalid_argument, saying what is missing, if a word has a letter that the system does not have
/// over T.
template <System S, Scalar T>
void require_served(const word& letters, const S& system) {
  for (const letter_facts& own : letters.own()) detail::require_declared<T>(letters, own, system);
  for (const char letter : letters.view()) {
    detail::with_letter(letter, detail::known_letters{}, [&]<class L>(const L&) {
      if constexpr (detail::steps_by_own_letters_only<S> && !StochasticFlow<L>) {
        throw std::invalid_argument(
            sentence("cannot step {} by the word {}: the letter {} must be one that the system declares, as "
                     "the system "
                     "has no force of H = K(p) + V(q)",
                     describe(system), letters.letters(), letter));
      }
      if constexpr (requires { L::needs; }) {
        if (!detail::letters_on(system).template serves<T>(letter)) {
          throw std::invalid_argument(
              sentence("cannot step {} by the word {}: {}", describe(system), letters.letters(), L::needs));
        }
      }
    });
  }
}

}  // namespace nysalt
