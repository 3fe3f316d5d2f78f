// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <string>

#include "nysalt/methods/palindromic.hpp"

namespace nysalt {

/// Three steps of position Verlet, of the lengths w, 1 - 2w and w with w = 1/(2 - 2^(1/3)):
///   A(w/2) B(w) A((1 - w)/2) B(1 - 2w) A((1 - w)/2) B(w) A(w/2),
/// order 4, three evaluations [forest_ruth_1990]. The middle step goes back by 1.7 h, which makes its error
/// the largest of its order and cost here.
struct forest_ruth : palindromic<drift, kick, 7> {
  static constexpr int order = 4;
  static std::string name() { return "forest_ruth"; }
  static constexpr std::array<double, 7> coefficients() {
    constexpr double cube_root_of_two = 1.2599210498948731648;
    constexpr double w = 1.0 / (2.0 - cube_root_of_two);
    return palindrome<7>({0.5 * w, w});
  }
};

}  // namespace nysalt
