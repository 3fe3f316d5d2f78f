// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <string>

#include "nysalt/methods/palindromic.hpp"

namespace nysalt {

/// A(a) B(1/2) A(1 - 2a) B(1/2) A(a) with the least error constant of its kind: order 2, two evaluations
/// [mclachlan_1995]. a = 1/2 - r/12 + 1/(6 r) with r = (36 + 2 sqrt(326))^(1/3).
struct mclachlan2 : palindromic<drift, kick, 5> {
  static constexpr int order = 2;
  static std::string name() { return "mclachlan2"; }
  static constexpr std::array<double, 5> coefficients() { return palindrome<5>({0.19318332750378357396}); }
};

}  // namespace nysalt
