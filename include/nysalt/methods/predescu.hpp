// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <string>

#include "nysalt/methods/palindromic.hpp"

namespace nysalt {

/// B(b) A(a) B(1/2 - b) A(1 - 2a) B(1/2 - b) A(a) B(b) with the least error on oscillators as z -> 0, where
/// that of energy is of fourth order: order 2, three evaluations [predescu_and_others_2012, equation (26)].
struct predescu3 : palindromic<kick, drift, 7> {
  static constexpr int order = 2;
  static std::string name() { return "predescu3"; }
  static constexpr std::array<double, 7> coefficients() {
    return palindrome<7>({0.108991425403425322, 0.290485609075128726});
  }
};

}  // namespace nysalt
