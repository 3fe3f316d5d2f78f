// SPDX-License-Identifier: BSL-1.0
// The step of a word on the harmonic oscillator, letter by letter.
#pragma once

#include <cstddef>
#include <stdexcept>
#include <type_traits>
#include <vector>

#include "nysalt/detail/sentence.hpp"
#include "nysalt/run_time_word.hpp"

namespace nysalt {

/// (q, p) after one step of size 1 of the word without its bath, on q'' = -(theta^2 + k) q. R rotates by
/// theta, S and H use k only, B and G all of it. times_k(x) is k x, so that k may be a number, the variable
/// of a polynomial, or, for two modes, a matrix; theta is a number, or an array of two. With a step h: theta
/// = h omega, k = h^2 kappa, and p counts in units of q/h.
template <class P, class Theta>
void step_on_oscillator(const run_time_word& word, const std::vector<double>& coefficients,
                        const Theta& theta, const auto& times_k, P& q, P& p) {
  const split_stiffness<Theta, std::remove_cvref_t<decltype(times_k)>> stiffness{theta, times_k};
  for (std::size_t i = 0; i < word.length; ++i) {
    const bool is_known = detail::with_letter(word.letters()[i], known_letters{}, [&](auto flow) {
      if constexpr (!StochasticFlow<decltype(flow)>) {
        flow.on_oscillator(stiffness, &coefficients[word.first_slot(i)], q, p);
      }
    });
    if (!is_known) {
      throw std::invalid_argument(
          sentence("the word {} must have letters whose action on an oscillator is known, got {}; examine "
                   "its stability by trial runs",
                   word.letters(), word.letters()[i]));
    }
  }
}

}  // namespace nysalt
