// SPDX-License-Identifier: BSL-1.0
// Requirements on a number type with which steps are taken.
#pragma once

#include <concepts>

namespace nysalt {

/// A field with double coefficients: double itself, a dual number, a truncated series, a ceres::Jet.
/// The type T decides what a step computes; systems, flows and families never ask.
// clang-format off
template <class T>
concept Scalar = std::copyable<T> && std::constructible_from<T, double> &&
                 requires(T x, const T& a, const T& b, double c) {
                   { a + b } -> std::same_as<T>;
                   { a - b } -> std::same_as<T>;
                   { a * b } -> std::same_as<T>;
                   { a / b } -> std::same_as<T>;
                   { -a } -> std::same_as<T>;
                   { c * a } -> std::same_as<T>;
                   { a * c } -> std::same_as<T>;
                   { a - c } -> std::same_as<T>;
                   x += b;
                   x -= b;
                 };

/// A coefficient is a double or has the state's scalar type; nothing else compiles, so that
/// mixed arithmetic cannot creep in.
template <class C, class T>
concept CoefficientOf = Scalar<C> && Scalar<T> && (std::same_as<C, double> || std::same_as<C, T>);
// clang-format on

/// States over T can be stepped with coefficients C: CoefficientOf, said of the state's scalar.
template <class T, class C>
concept SteppedBy = CoefficientOf<C, T>;

/// a where the condition holds, else b. Systems that write it instead of a branch serve packs and their duals
/// too, where the condition may differ from lane to lane.
inline double select(bool condition, double a, double b) { return condition ? a : b; }
inline bool any(bool condition) { return condition; }  ///< whether the condition holds in any lane

}  // namespace nysalt
