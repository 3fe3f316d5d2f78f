// SPDX-License-Identifier: BSL-1.0
// Requirements on a number type with which steps are taken.
#pragma once

#include <cmath>
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

// Functions that <cmath> lacks, over double; and over each class of numbers those that are written by
// select(), and the forms with a double on one side. Each class has its own elementary functions beside it.
/// Sign of x: -1, 0 or 1, and 0 for NaN. The derivative is 0.
inline double sign(double x) { return x > 0.0 ? 1.0 : x < 0.0 ? -1.0 : 0.0; }
/// Heaviside's step: 0 for x < 0, else 1. The derivative is 0.
inline double heaviside(double x) { return x < 0.0 ? 0.0 : 1.0; }
/// Remainder a - b floor(a/b), exact but for one rounding: in [0, b] for b > 0, in [b, 0] for b < 0.
inline double mod(double a, double b) {
  const double rest = std::fmod(a, b);
  return rest != 0.0 && (rest < 0.0) != (b < 0.0) ? rest + b : rest;
}

/// Whether a type is a class of numbers with the elementary functions: duals, packs, compensated numbers.
template <class T>
inline constexpr bool has_functions = false;

/// Sign of a: -1, 0 or 1, and 0 for NaN. The derivative is 0.
template <class S>
  requires has_functions<S>
S sign(const S& a) {
  return select(a > 0.0, S(1.0), select(a < 0.0, S(-1.0), S(0.0)));
}
/// Heaviside's step: 0 for a < 0, else 1. The derivative is 0.
template <class S>
  requires has_functions<S>
S heaviside(const S& a) {
  return select(a < 0.0, S(0.0), S(1.0));
}
/// Smaller of two; a where they are equal.
template <class S>
  requires has_functions<S>
S min(const S& a, const S& b) {
  return select(b < a, b, a);
}
template <class S>
  requires has_functions<S>
S min(const S& a, double b) {
  return min(a, S(b));
}
template <class S>
  requires has_functions<S>
S min(double a, const S& b) {
  return min(S(a), b);
}
/// Larger of two; a where they are equal.
template <class S>
  requires has_functions<S>
S max(const S& a, const S& b) {
  return select(a < b, b, a);
}
template <class S>
  requires has_functions<S>
S max(const S& a, double b) {
  return max(a, S(b));
}
template <class S>
  requires has_functions<S>
S max(double a, const S& b) {
  return max(S(a), b);
}
/// Remainder a - b floor(a/b) beside a number.
template <class S>
  requires has_functions<S>
S mod(const S& a, double b) {
  return mod(a, S(b));
}
/// Remainder a - b floor(a/b) beside a number.
template <class S>
  requires has_functions<S>
S mod(double a, const S& b) {
  return mod(S(a), b);
}
/// Angle of (x, y) beside a number.
template <class S>
  requires has_functions<S>
S atan2(const S& y, double x) {
  return atan2(y, S(x));
}
/// Angle of (x, y) beside a number.
template <class S>
  requires has_functions<S>
S atan2(double y, const S& x) {
  return atan2(S(y), x);
}
/// sqrt(x^2 + y^2), without overflow beside a number.
template <class S>
  requires has_functions<S>
S hypot(const S& x, double y) {
  return hypot(x, S(y));
}
/// sqrt(x^2 + y^2), without overflow beside a number.
template <class S>
  requires has_functions<S>
S hypot(double x, const S& y) {
  return hypot(S(x), y);
}
/// Power of two arguments beside a number.
template <class S>
  requires has_functions<S>
S pow(double a, const S& exponent) {
  return pow(S(a), exponent);
}

}  // namespace nysalt
