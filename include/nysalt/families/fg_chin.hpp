// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <array>
#include <string_view>
#include <type_traits>

#include "nysalt/families/composition.hpp"
#include "nysalt/flows/drift.hpp"
#include "nysalt/flows/gradient_kick.hpp"

namespace nysalt {

/// B(b) A(1/2) G(1 - 2 b, c) A(1/2) B(b): three evaluations, one minimum. At b = 1/6, c = 1/72 Chin's method
/// 4A [chin_1997].
struct fg_chin : composition<2> {
  using word = nysalt::word<kick, drift, gradient_kick, drift, kick>;
  static constexpr std::string_view name = "fg_chin";
  static constexpr std::string_view source = "chin_1997";
  static constexpr std::array<std::string_view, 2> parameter_names{"b", "c"};
  static constexpr int order = 2;
  static constexpr bool symmetric = true;
  static constexpr bool requires_quadratic_kinetic = true;

  static std::array<double, 2> start() { return {1.0 / 6.0, 1.0 / 72.0}; }

  /// Two equal steps of kick-drift-kick.
  static std::array<double, 2> most_stable_member() { return {0.25, 0.0}; }

  /// Parameters of a method of this word.
  template <class M>
  static std::array<double, 2> of(const M& method) {
    static_assert(std::is_same_v<typename M::word, word>);
    const auto c = method.coefficients();
    return {c[0], c[3]};
  }

  template <Scalar C>
  static std::array<C, 6> coefficients(const std::array<C, 2>& theta) {
    const auto& [b, c] = theta;
    return {b, C(0.5), C(1.0) - b * 2.0, c, C(0.5), b};
  }
};

}  // namespace nysalt
