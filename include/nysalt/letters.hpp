// SPDX-License-Identifier: BSL-1.0
// The letters that words are made of: the letters of the library in one table, and the letters of a system.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>

#include "nysalt/flow.hpp"
#include "nysalt/flows/drift_kick.hpp"
#include "nysalt/flows/gradient_kick.hpp"
#include "nysalt/flows/ornstein_uhlenbeck.hpp"
#include "nysalt/flows/rotation.hpp"

namespace nysalt {

namespace detail {

/// A few characters as a constant.
struct short_text {
  static constexpr std::size_t most = 16;  ///< largest number of characters
  std::array<char, most> characters{};     ///< the text, then zeros
  std::size_t size = 0;                    ///< number of characters

  constexpr short_text() = default;
  /// Characters beyond the largest number are left out.
  constexpr short_text(std::string_view text) : size(std::min(text.size(), most)) {
    std::copy_n(text.begin(), size, characters.begin());
  }
  constexpr std::string_view view() const { return {characters.data(), size}; }  ///< the text
  bool operator==(const short_text&) const = default;                            ///< equal texts
};

}  // namespace detail

/// What a letter states of itself, as a value: what a word is made of.
struct letter_facts {
  char letter = '?';                  ///< name of the letter
  std::size_t slots = 1;              ///< number of coefficients
  field reads = field::none;          ///< the force that must be known when the letter is applied
  int power_of_second = 1;            ///< power of h that goes with coefficients behind the first
  int force_derivatives = 0;          ///< number of f'(q) v that the letter evaluates
  int displaced_forces = 0;           ///< number of forces that the letter evaluates itself
  bool moves_q = true;                ///< whether a known force is stale afterwards
  bool additive = true;               ///< whether equal neighbours merge
  bool symplectic = true;             ///< whether the letter is a symplectic map
  bool is_of_bath = false;            ///< whether the letter is O
  bool reads_modes = false;           ///< whether the letter is prepared with the modes of the system
  splitting splits = splitting::any;  ///< the splitting of H that the letter belongs to
  bool invertible = false;            ///< whether negated coefficients take the letter back
  bool reversible = true;             ///< whether R letter R letter is the identity, R(q, p) = (q, -p)
  detail::short_text times{};         ///< part of H whose time each coefficient is, a character for each
  detail::short_text parts{};         ///< parts of V whose force the letter evaluates, a digit for each

  bool operator==(const letter_facts&) const = default;  ///< equal in all
};

namespace detail {

/// The facts that the type of a letter states.
template <Flow L>
constexpr letter_facts facts_of_letter() {
  letter_facts result{.letter = L::letter,
                      .slots = L::slots,
                      .reads = L::reads,
                      .force_derivatives = L::force_derivatives,
                      .displaced_forces = detail::displaced_forces_of<L>(),
                      .moves_q = L::moves_q,
                      .additive = L::additive,
                      .symplectic = detail::is_symplectic<L>(),
                      .is_of_bath = StochasticFlow<L>,
                      .reads_modes = QuadraticFlow<L>,
                      .splits = detail::splitting_of<L>()};
  if constexpr (requires { L::power_of_second; }) result.power_of_second = L::power_of_second;
  if constexpr (requires { L::invertible; }) result.invertible = L::invertible;
  if constexpr (requires { L::reversible; }) result.reversible = L::reversible;
  if constexpr (requires { std::string_view(L::times); }) {
    result.times = std::string_view(L::times);
  } else if constexpr (L::slots == 1) {
    result.times = std::string_view(&result.letter, 1);
  }
  if constexpr (requires { L::evaluations_of_part(0); }) {
    std::array<char, 10> parts{};
    std::size_t count = 0;
    for (std::size_t part = 0; part < 10; ++part) {
      if (L::evaluations_of_part(part) > 0) parts[count++] = static_cast<char>('0' + part);
    }
    result.parts = std::string_view(parts.data(), count);
  }
  return result;
}

/// Every letter of the library: a new one is a flow, and an entry here.
using known_letters = std::tuple<drift, kick, gradient_kick, displaced_kick, rotation, soft_kick,
                                 soft_gradient_kick, ornstein_uhlenbeck>;

template <class... L>
constexpr std::array<letter_facts, sizeof...(L)> facts_of_letters(const std::tuple<L...>*) {
  return {facts_of_letter<L>()...};
}

/// f(flow) for the flow of that letter among the given ones; false if there is none.
template <class... L>
[[gnu::always_inline]] inline bool with_letter([[maybe_unused]] char letter, std::tuple<L...>,
                                               [[maybe_unused]] auto&& f) {
  return ((L::letter == letter && (f(L{}), true)) || ...);
}

template <class L, class Known>
inline constexpr bool is_among = false;
template <class L, class... Known>
inline constexpr bool is_among<L, std::tuple<Known...>> = (std::is_same_v<L, Known> || ...);

/// The facts of the letters of the library.
inline constexpr auto letter_table = detail::facts_of_letters(static_cast<const known_letters*>(nullptr));

/// Whether a character is the name of a letter of the library.
constexpr bool is_known_letter(char letter) {
  return std::ranges::any_of(letter_table, [=](const letter_facts& one) { return one.letter == letter; });
}
}  // namespace detail

// Letters that a system has beside the library's.

namespace detail {

template <class S>
struct letters_of_system {
  using type = std::tuple<>;
};
template <class S>
  requires requires { typename S::letters; }
struct letters_of_system<S> {
  using type = typename S::letters;
};

/// The letters that S declares as `using letters = std::tuple<...>`, none where S declares none.
template <class S>
using letters_of = typename letters_of_system<S>::type;

/// Whether letters of the library do not step S, since H is not K(p) + V(q).
template <class S>
inline constexpr bool steps_by_own_letters_only =
    !ErasedSystem<S> && !SystemOver<S, double> && std::tuple_size_v<letters_of<S>> > 0;

template <class... L>
consteval bool are_letters_of_users(const std::tuple<L...>*) {
  return (Flow<L> && ...) && (!is_known_letter(L::letter) && ...);
}
template <class... L>
consteval bool have_different_names(const std::tuple<L...>*) {
  const std::array<char, sizeof...(L)> names{L::letter...};
  for (std::size_t i = 0; i < names.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      if (names[i] == names[k]) return false;
    }
  }
  return true;
}

}  // namespace detail

/// A system with letters of the user's own beside those that it declares: all other members are inherited
/// from S.
template <System S, Flow... L>
struct with_letters : S {
  using letters = decltype(std::tuple_cat(
      detail::letters_of<S>(),
      std::conditional_t<detail::is_among<L, detail::letters_of<S>>, std::tuple<>, std::tuple<L>>()...));
  static_assert(detail::are_letters_of_users(static_cast<const std::tuple<L...>*>(nullptr)),
                "nysalt: a letter of one's own takes a character that no known letter has");
  static_assert(detail::have_different_names(static_cast<const letters*>(nullptr)),
                "nysalt: letters of one's own must have different names; name one of them otherwise");
  using S::S;
  with_letters() = default;
  explicit with_letters(const S& system) : S(system) {}  ///< a copy of the system
};

}  // namespace nysalt
