// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <array>
#include <string_view>

#include "nysalt/families/parameters.hpp"
#include "nysalt/flows/drift_kick.hpp"
#include "nysalt/word.hpp"

namespace nysalt {

/// The explicit symplectic two-stage Nystrom methods S_{b1, beta1} [li_lu_tao_ye_2023, equations (2.7-11)],
/// written as the composition that they are [okunbor_skeel_1992]:
///   A(c1) B(b1) A(c2 - c1) B(b2) A(1 - c2),  c_i = 1 - beta_i/b_i,  b2 = 1 - b1,  beta2 = 1/2 - beta1.
/// Members: (1/2, 1/2) velocity Verlet, (1/2, 3/8) two half steps of drift-kick-drift,
/// (1/2, 0.4034) McLachlan's. Symmetric where b1 = 1/2. Two evaluations a step.
struct nystrom {
  static constexpr word letters{"ABABA"};
  static constexpr std::string_view name = "nystrom";
  static constexpr std::string_view source = "okunbor_skeel_1992";
  static constexpr int parameters = 2;
  static constexpr std::array<std::string_view, 2> parameter_names{"b1", "beta1"};
  static constexpr int order = 2;
  static constexpr bool symmetric = false;
  static constexpr bool requires_quadratic_kinetic = false;

  /// 0 < b1 < 1 and 0 <= beta1 <= 1/2 [li_lu_tao_ye_2023, equation (3.3)]; Verlet lies on the bound beta1 =
  /// 1/2.
  static std::array<parameter_range, 2> ranges() { return {{{0.0, 1.0, true}, {0.0, 0.5, false}}}; }
  /// The optimum at small steps: beta1 = (1 - a)/2 with McLachlan's a [mclachlan_1995].
  static std::array<double, 2> start() { return {0.5, 0.5 * (1.0 - 0.19318332750378357396)}; }

  /// Two equal steps of drift-kick-drift.
  static std::array<double, 2> most_stable_member() { return {0.5, 0.375}; }

  template <Scalar C>
  static std::array<C, 5> coefficients(const std::array<C, 2>& theta) {
    const C& b1 = theta[0];
    const C& beta1 = theta[1];
    const C one(1.0);
    const C b2 = one - b1;
    const C beta2 = C(0.5) - beta1;
    const C c1 = one - beta1 / b1;
    const C c2 = one - beta2 / b2;
    return {c1, b1, c2 - c1, b2, one - c2};
  }
};

}  // namespace nysalt
