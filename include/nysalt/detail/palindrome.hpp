// SPDX-License-Identifier: BSL-1.0
// Words of two letters in turn that read the same from both ends.
#pragma once

#include <array>
#include <cstddef>
#include <type_traits>
#include <utility>

#include "nysalt/word.hpp"

namespace nysalt {

namespace detail {
template <Flow First, Flow Second, std::size_t... I>
auto alternate(std::index_sequence<I...>) -> word<std::conditional_t<I % 2 == 0, First, Second>...>;
}  // namespace detail

/// First Second First ... of the given odd length.
template <Flow First, Flow Second, std::size_t Length>
  requires(Length % 2 == 1)
using alternating_word = decltype(detail::alternate<First, Second>(std::make_index_sequence<Length>{}));

/// The coefficients x_1 y_1 x_2 y_2 ... y_2 x_2 y_1 x_1 of such a word from its first ones: the middle one
/// and its neighbour follow from consistency, sum x = sum y = 1. Symmetric, hence of even order.
template <std::size_t Length, class C = double>
  requires(Length % 2 == 1 && Length >= 3)
constexpr std::array<C, Length> palindrome(const std::array<C, (Length - 3) / 2>& free) {
  constexpr std::size_t middle = (Length - 1) / 2;
  std::array<C, Length> all{};
  C of_middle_letter(1.0);
  C of_neighbour(0.5);
  for (std::size_t i = 0; i + 1 < middle; ++i) {
    all[i] = free[i];
    if (i % 2 == middle % 2) {
      of_middle_letter = of_middle_letter - 2.0 * free[i];
    } else {
      of_neighbour = of_neighbour - free[i];
    }
  }
  all[middle - 1] = of_neighbour;
  all[middle] = of_middle_letter;
  for (std::size_t i = 0; i < middle; ++i) all[Length - 1 - i] = all[i];
  return all;
}

}  // namespace nysalt
