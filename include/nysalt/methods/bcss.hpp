// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <string>

#include "nysalt/methods/palindromic.hpp"

namespace nysalt {

/// A(a) B(1/2) A(1 - 2a) B(1/2) A(a) with the least energy error on oscillators up to z = 2: order 2, two
/// evaluations [blanes_casas_sanz_serna_2014, the method of two stages].
struct bcss2 : palindromic<drift, kick, 5> {
  static constexpr int order = 2;
  static std::string name() { return "bcss2"; }
  static constexpr std::array<double, 5> coefficients() { return palindrome<5>({0.211781}); }
};

/// B(b) A(a) B(1/2 - b) A(1 - 2a) B(1/2 - b) A(a) B(b), the same up to z = 3: order 2, three evaluations
/// [blanes_casas_sanz_serna_2014, the method of three stages].
struct bcss3 : palindromic<kick, drift, 7> {
  static constexpr int order = 2;
  static std::string name() { return "bcss3"; }
  static constexpr std::array<double, 7> coefficients() {
    return palindrome<7>({0.11888010966548, 0.29619504261126});
  }
};

/// B A B A B A B A B, the same up to z = 4: order 2, four evaluations [blanes_casas_sanz_serna_2014, equation
/// (6.8)].
struct bcss4 : palindromic<kick, drift, 9> {
  static constexpr int order = 2;
  static std::string name() { return "bcss4"; }
  static constexpr std::array<double, 9> coefficients() {
    return palindrome<9>({0.071353913450279725904, 0.191667800000000000000, 0.268548791161230105820});
  }
};

}  // namespace nysalt
