// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <string>

#include "nysalt/methods/palindromic.hpp"

namespace nysalt {

/// Position-extended Forest-Ruth-like: A(xi) B((1 - 2 lambda)/2) A(chi) B(lambda) A(1 - 2(chi + xi)) ...,
/// order 4, four evaluations [omelyan_mryglod_folk_2002].
struct pefrl : palindromic<drift, kick, 9> {
  static constexpr int order = 4;
  static std::string name() { return "pefrl"; }
  static constexpr std::array<double, 9> coefficients() {
    constexpr double xi = 0.1786178958448091;
    constexpr double lambda = -0.2123418310626054;
    constexpr double chi = -0.06626458266981849;
    return palindrome<9>({xi, 0.5 - lambda, chi});
  }
};

}  // namespace nysalt
