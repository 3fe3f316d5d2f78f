// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <array>
#include <cstddef>
#include <string_view>
#include <type_traits>

#include "nysalt/detail/palindrome.hpp"
#include "nysalt/families/composition.hpp"

namespace nysalt {

/// x_1 y_1 x_2 y_2 ... y_2 x_2 y_1 x_1 with x and y each adding up to 1: symmetric, of order 2. Parameters
/// are the coefficients from the left; the last of each letter follow from the sums. Where the steps of words
/// of s = 4 kicks and more are large, the best of them hold large kicks of opposite sign around a short
/// drift: a gradient kick by differences, along a flat valley.
template <Flow Outer, Flow Inner, std::size_t Length>
struct symmetric_composition : composition<(static_cast<int>(Length) - 3) / 2> {
  using word = alternating_word<Outer, Inner, Length>;
  static constexpr std::size_t free = (Length - 3) / 2;
  static constexpr auto parameter_names = names_in_turn<free>(Outer::reads != field::none);
  static constexpr int order = 2;
  static constexpr bool symmetric = true;
  static constexpr bool requires_quadratic_kinetic = QuadraticFlow<Outer>;

  /// Equal steps of drift-kick-drift, or of kick-drift-kick.
  static std::array<double, free> start() {
    constexpr double inner = 2.0 / static_cast<double>(Length - 1);
    std::array<double, free> all;
    all.fill(inner);
    all[0] = 0.5 * inner;
    return all;
  }

  template <Scalar C>
  static std::array<C, Length> coefficients(const std::array<C, free>& theta) {
    return palindrome<Length, C>(theta);
  }

  /// The parameters that a classical method of this word has.
  template <class M>
  static std::array<double, free> of(const M& method) {
    static_assert(std::is_same_v<typename M::word, word> || QuadraticFlow<Outer>);
    std::array<double, free> all;
    const auto c = method.coefficients();
    for (std::size_t k = 0; k < free; ++k) all[k] = c[k];
    return all;
  }
};

namespace detail {
/// "aba4" for the prefix "aba" and 4 kicks, below 10.
template <std::size_t Length>
struct numbered_name {
  std::array<char, Length> text{};
  constexpr numbered_name(std::string_view prefix, int number) {
    for (std::size_t i = 0; i + 1 < Length; ++i) text[i] = prefix[i];
    text[Length - 1] = static_cast<char>('0' + number);
  }
};
}  // namespace detail

}  // namespace nysalt
