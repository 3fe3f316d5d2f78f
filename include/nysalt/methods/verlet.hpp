// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <string>

#include "nysalt/methods/palindromic.hpp"

namespace nysalt {

/// B(1/2) A B(1/2): velocity Verlet, order 2, one evaluation a step
/// [verlet_1967; hairer_lubich_wanner_2006, section I.1.4].
struct verlet : palindromic<kick, drift, 3> {
  static constexpr int order = 2;
  static std::string name() { return "verlet"; }
  static constexpr std::array<double, 3> coefficients() { return palindrome<3>({}); }
};

/// A(1/2) B A(1/2): position Verlet, order 2, one evaluation a step.
struct verlet_aba : palindromic<drift, kick, 3> {
  static constexpr int order = 2;
  static std::string name() { return "verlet_aba"; }
  static constexpr std::array<double, 3> coefficients() { return palindrome<3>({}); }
};

/// Two half steps of velocity Verlet: what every two-stage method must beat, at its cost.
struct verlet_2x : palindromic<kick, drift, 5> {
  static constexpr int order = 2;
  static std::string name() { return "verlet_2x"; }
  static constexpr std::array<double, 5> coefficients() { return palindrome<5>({0.25}); }
};

}  // namespace nysalt
