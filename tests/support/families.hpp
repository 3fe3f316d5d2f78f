// SPDX-License-Identifier: BSL-1.0
// Families of one and of three parameters, for what must not depend on their number.
#pragma once

#include "nysalt/family.hpp"
#include "nysalt/flows/drift.hpp"
#include "nysalt/flows/kick.hpp"

namespace nysalt::test {

/// A(a) B(1/2) A(1 - 2a) B(1/2) A(a): every symmetric method of two kicks.
struct aba2 {
  using word = nysalt::word<drift, kick, drift, kick, drift>;
  static constexpr std::string_view name = "aba2";
  static constexpr int parameters = 1;
  static constexpr std::array<std::string_view, 1> parameter_names{"a"};
  static constexpr int order = 2;
  static constexpr bool symmetric = true;
  static constexpr bool requires_quadratic_kinetic = false;
  static std::array<parameter_range, 1> ranges() { return {{{0.0, 0.5, false}}}; }
  static std::array<double, 1> start() { return {0.19}; }

  template <Scalar C>
  static std::array<C, 5> coefficients(const std::array<C, 1>& theta) {
    const C& a = theta[0];
    const C half(0.5);
    return {a, half, C(1.0) - a - a, half, a};
  }
};

/// A(a1) B(b) A(a2) B(1/2 - b) A(1 - 2 (a1 + a2)) and back: every symmetric method of four kicks. On one
/// linear oscillator a step has fewer degrees of freedom than that.
struct aba4 {
  using word = nysalt::word<drift, kick, drift, kick, drift, kick, drift, kick, drift>;
  static constexpr std::string_view name = "aba4";
  static constexpr int parameters = 3;
  static constexpr std::array<std::string_view, 3> parameter_names{"a1", "a2", "b"};
  static constexpr int order = 2;
  static constexpr bool symmetric = true;
  static constexpr bool requires_quadratic_kinetic = false;
  static std::array<parameter_range, 3> ranges() {
    return {{{-1.0, 1.0, false}, {-1.0, 1.0, false}, {-1.0, 1.0, false}}};
  }
  static std::array<double, 3> start() { return {0.18, -0.07, 0.71}; }  // near pefrl

  template <Scalar C>
  static std::array<C, 9> coefficients(const std::array<C, 3>& theta) {
    const auto& [a1, a2, b] = theta;
    const C middle = C(1.0) - (a1 + a2) * 2.0;
    const C other = C(0.5) - b;
    return {a1, b, a2, other, middle, other, a2, b, a1};
  }
};

static_assert(Family<aba2> && Family<aba4>);

}  // namespace nysalt::test
