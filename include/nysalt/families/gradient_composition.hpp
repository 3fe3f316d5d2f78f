// SPDX-License-Identifier: BSL-1.0
// Families with force gradients: as the letter G, or as kicks at displaced positions.
#pragma once

#include <array>
#include <cmath>
#include <stdexcept>
#include <string_view>
#include <type_traits>
#include <vector>

#include "nysalt/core/sentence.hpp"
#include "nysalt/families/composition.hpp"
#include "nysalt/flows/drift_kick.hpp"
#include "nysalt/flows/gradient_kick.hpp"
#include "nysalt/flows/rotation.hpp"
#include "nysalt/methods/classical.hpp"

namespace nysalt {

namespace detail {

/// X(a) Y(b) X(1/2 - a) Z(1 - 2 b, c) X(1/2 - a) Y(b) X(a) with a gradient kick Z: four evaluations.
template <Flow X, Flow Y, Flow Z>
struct gradient_composition : composition<3> {
  static constexpr word letters = word_of<X, Y, X, Z, X, Y, X>();
  static constexpr std::string_view source = "takahashi_imada_1984";  // of the gradient kick
  static constexpr std::array<std::string_view, 3> parameter_names{"a", "b", "c"};
  static constexpr int order = 2;
  static constexpr bool symmetric = true;
  static constexpr bool requires_quadratic_kinetic = true;

  /// Chin's method 4A, where a = 0.
  static std::array<double, 3> start() { return of_order_four(0.0); }

  static std::vector<classical_member<3>> classical_members() { return {{"omelyan_fg4", of(omelyan_fg4())}}; }

  /// The member of order 4 that has this a: b = 1/(6 (1 - 2 a)^2) and c = (1/6 - (1 - 2 a) b (1 - b))/2
  /// [omelyan_mryglod_folk_2003, equation (44)]. Throws std::invalid_argument at a = 1/2, where there is
  /// none.
  static std::array<double, 3> of_order_four(double a) {
    const double middle = 1.0 - 2.0 * a;
    if (!(std::abs(middle) > 0.0) || !std::isfinite(a)) {
      throw std::invalid_argument(
          sentence("of_order_four: a must be finite and not 1/2, got {}; take a near 0.1", a));
    }
    const double b = 1.0 / (6.0 * middle * middle);
    return {a, b, 0.5 * (1.0 / 6.0 - middle * b * (1.0 - b))};
  }

  /// The parameters that a method of this word has. Rotations may replace the drifts.
  static std::array<double, 3> of(const nysalt::method& method) {
    const auto& c = method.coefficients();
    return {c[0], c[1], c[4]};
  }

  /// Three equal steps of drift-kick-drift.
  static std::array<double, 3> most_stable_member() { return {1.0 / 6.0, 1.0 / 3.0, 0.0}; }

  template <Scalar C>
  static std::array<C, 8> coefficients(const std::array<C, 3>& theta) {
    const auto& [a, b, c] = theta;
    const C rest = C(0.5) - a;
    return {a, b, rest, C(1.0) - b * 2.0, c, rest, b, a};
  }
};

}  // namespace detail

/// A(a) B(b) A(1/2 - a) G(1 - 2 b, c) A(1/2 - a) B(b) A(a); fg_chin where a = 0.
struct fg4 : detail::gradient_composition<drift, kick, gradient_kick> {
  static constexpr std::string_view name = "fg4";
};

/// R(a) S(b) R(1/2 - a) H(1 - 2 b, c) R(1/2 - a) S(b) R(a), for systems that declare a quadratic part.
struct r_fg4 : detail::gradient_composition<rotation, soft_kick, soft_gradient_kick> {
  static constexpr std::string_view name = "r_fg4";
};

namespace detail {

/// B(b) A(1/2) X(1 - 2 b, c) A(1/2) B(b) with a kick X that uses derivatives of the force: three evaluations.
template <Flow Middle>
struct chin_composition : composition<2> {
  static constexpr word letters = word_of<kick, drift, Middle, drift, kick>();
  static constexpr std::array<std::string_view, 2> parameter_names{"b", "c"};
  static constexpr int order = 2;
  static constexpr bool symmetric = true;
  static constexpr bool requires_quadratic_kinetic = true;

  /// Two equal steps of kick-drift-kick.
  static std::array<double, 2> most_stable_member() { return {0.25, 0.0}; }

  template <Scalar C>
  static std::array<C, 6> coefficients(const std::array<C, 2>& theta) {
    const auto& [b, c] = theta;
    return {b, C(0.5), C(1.0) - b * 2.0, c, C(0.5), b};
  }
};

}  // namespace detail

/// With the letter G: one minimum. At b = 1/6, c = 1/72 Chin's method 4A [chin_1997].
struct fg_chin : detail::chin_composition<gradient_kick> {
  static constexpr std::string_view name = "fg_chin";
  static constexpr std::string_view source = "chin_1997";

  static std::array<double, 2> start() { return {1.0 / 6.0, 1.0 / 72.0}; }

  /// Parameters of a method of this word.
  static std::array<double, 2> of(const nysalt::method& method) {
    const auto& c = method.coefficients();
    return {c[0], c[3]};
  }
};

/// With the letter D: no evaluation is a derivative. At b = 1/6, c = 1/24 Chin's method 4A with a displaced
/// kick; not symplectic, and for sampling only.
struct fd_chin : detail::chin_composition<displaced_kick> {
  static constexpr std::string_view name = "fd_chin";
  static constexpr std::string_view source = "yin_mawhinney_2011";

  static std::array<double, 2> start() { return {1.0 / 6.0, 1.0 / 24.0}; }
};

}  // namespace nysalt
