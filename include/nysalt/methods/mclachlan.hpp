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

/// A(a1) B(2/5) A(a2) B(-1/10) A(1/2 - a1 - a2) B(2/5) ... with a1 = (14 - sqrt 19)/108 and
/// a2 = (20 - 7 sqrt 19)/108, the least error constant of its kind: order 4, five evaluations
/// [mclachlan_1995]. (Not the composition of five Verlet steps in the same paper.)
struct mclachlan5 : palindromic<drift, kick, 11> {
  static constexpr int order = 4;
  static std::string name() { return "mclachlan5"; }
  static constexpr std::array<double, 11> coefficients() {
    constexpr double root_of_19 = 4.3588989435406735522;
    constexpr double a1 = (14.0 - root_of_19) / 108.0;
    constexpr double a2 = (20.0 - 7.0 * root_of_19) / 108.0;
    return palindrome<11>({a1, 0.4, a2, -0.1});
  }
};

}  // namespace nysalt
