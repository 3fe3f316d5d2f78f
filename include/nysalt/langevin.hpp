// SPDX-License-Identifier: BSL-1.0
// Placements of the letters O in a word that has none.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "nysalt/core/sentence.hpp"
#include "nysalt/noise.hpp"
#include "nysalt/word.hpp"

namespace nysalt {

/// Placement of letters O in a thermostatted word S, over a whole step or two halves:
///   end        S O              [li_lu_tao_ye_2023, equation (2.13)]
///   symmetric  O/2 S O/2        one draw a step
///   middle     S with its central letter X split: ... X/2 O X/2 ...
enum class placement { end, symmetric, middle };

/// All placements, in that order.
inline constexpr std::array placements{placement::end, placement::symmetric, placement::middle};

/// Name of a placement in programs and files: end, symmetric or middle.
constexpr std::string_view to_string(placement p) {
  constexpr std::array<std::string_view, 3> names{"end", "symmetric", "middle"};
  return names[static_cast<std::size_t>(p)];
}

namespace detail {

/// The order of a word S with letters O where the bath has no noise (sigma = 0): 1 where O is at the end,
/// or in the middle of what is not symmetric; else at most 2, as O and S do not commute.
constexpr int thermostatted_order(placement p, int order, bool symmetric) {
  const bool is_first = p == placement::end || (p == placement::middle && !symmetric);
  return is_first ? 1 : std::min(order, 2);
}

}  // namespace detail

/// A word with its letters O. Throws std::invalid_argument if it has some already, if it has no central
/// letter to split, or if it is processed: only the kernel decides the temperature of a mode, as a processor
/// changes no action, and a kernel that was learned with a processor may have any.
inline word thermostatted(const word& letters, placement where);

namespace detail {

/// The coefficients of a word with the coefficients of its letters O, in the order of thermostatted().
template <class C>
std::vector<C> thermostatted_coefficients(const word& letters, placement where, const std::vector<C>& c) {
  const std::size_t central = letters.length / 2;
  const std::size_t first = letters.first_slot(central);
  const std::size_t end = first + letters.slots_of(central);
  std::vector<C> result;
  if (where == placement::symmetric) result.push_back(C(0.5));
  for (std::size_t i = 0; i < c.size(); ++i) {
    const bool is_split = where == placement::middle && first <= i && i < end;
    result.push_back(is_split ? C(c[i] * 0.5) : c[i]);
    if (!is_split || i + 1 < end) continue;
    result.push_back(C(1.0));
    for (std::size_t k = first; k < end; ++k) result.push_back(C(c[k] * 0.5));
  }
  if (where == placement::symmetric) result.push_back(C(0.5));
  if (where == placement::end) result.push_back(C(1.0));
  return result;
}

/// Intervals of a step that the letters O of a word cover. Throws std::invalid_argument unless they share it
/// as noise_intervals says.
inline noise_intervals intervals_of_noise(const word& letters, const std::vector<double>& coefficients);

}  // namespace detail

inline word thermostatted(const word& letters, placement where) {
  const std::string text = letters.letters();
  if (letters.stochastic_letters > 0) {
    throw std::invalid_argument(sentence("thermostat: the word must have no letters O, got {}", text));
  }
  if (letters.is_processed()) {
    throw std::invalid_argument(
        sentence("thermostat: the word in a bath must have no processor, got {}; take one without, as a "
                 "kernel that is made for a processor gives modes another temperature",
                 text));
  }
  const std::string o(1, detail::bath_letter);
  if (where == placement::end) return letters.with_letters(text + o);
  if (where == placement::symmetric) return letters.with_letters(o + text + o);
  if (text.size() % 2 == 0) {
    throw std::invalid_argument(
        sentence("thermostat: the word must have a central letter to split, got {}; place O at the end, or "
                 "symmetric",
                 text));
  }
  const std::size_t central = text.size() / 2;
  return letters.with_letters(text.substr(0, central + 1) + o + text.substr(central));
}

inline detail::noise_intervals detail::intervals_of_noise(const word& letters,
                                                          const std::vector<double>& coefficients) {
  std::vector<double> of_bath;
  for (std::size_t i = 0; i < letters.length; ++i) {
    if (letters.letter(i) == detail::bath_letter) of_bath.push_back(coefficients[letters.first_slot(i)]);
  }
  return detail::intervals_of_noise(letters.letters(), of_bath);
}

}  // namespace nysalt
