// SPDX-License-Identifier: BSL-1.0
// Numbers that remember what rounding took from their sums: for very long runs and very small steps.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <concepts>

#include "nysalt/scalar.hpp"

namespace examples {

using namespace nysalt;
using nysalt::mod, nysalt::select;  // of their values

/// value + carry. += and -= keep what rounding takes from the sum in the carry, and give it back with the
/// next summand [kahan_1965], by a sum of two that asks for no order of them [moller_1965]. All else reads
/// the value and rounds as T does, at the cost of T.
///
/// A stepper that is opened over compensated<T> is the same loop: only the sums into q and p are compensated.
/// They no longer round by eps |q| and eps |p| a step, but by what the increments do, eps h |p| and
/// eps h |f|: some h omega times as much [hairer_lubich_wanner_2006, section VIII.5]. T is double or a pack.
///     auto run = stepper.open(start.cast<compensated<double>>());
///     stepper.advance(run, steps);
///     const auto finish = stepper.synchronous(run).cast<double>();
/// Cost: a sum is 7 operations instead of 1, of which the next step waits for 2.
template <Scalar T>
struct compensated {
  T value{};  ///< the sum, rounded to T
  T carry{};  ///< rounding error of the value, which enters the next sum

  compensated() = default;
  compensated(double x) : value(x), carry(0.0) {}  ///< a number without carry
  compensated(const T& x)
    requires(!std::same_as<T, double>)
      : value(x), carry(0.0) {}                  ///< a number without carry
  explicit operator T() const { return value; }  ///< value without the carry

  compensated& operator+=(const compensated& b) {
    const T summand = b.value + carry;
    const T sum = value + summand;
    const T added = sum - value;
    carry = (value - (sum - added)) + (summand - added);
    value = sum;
    return *this;
  }
  compensated& operator-=(const compensated& b) { return *this += -b; }
  compensated& operator*=(const compensated& b) { return *this = *this * b; }
  compensated& operator/=(const compensated& b) { return *this = *this / b; }

  friend compensated operator+(const compensated& a, const compensated& b) { return T(a.value + b.value); }
  friend compensated operator-(const compensated& a, const compensated& b) { return T(a.value - b.value); }
  friend compensated operator*(const compensated& a, const compensated& b) { return T(a.value * b.value); }
  friend compensated operator/(const compensated& a, const compensated& b) { return T(a.value / b.value); }
  friend compensated operator-(const compensated& a) { return T(-a.value); }

  friend auto operator<(const compensated& a, const compensated& b) { return a.value < b.value; }
  friend auto operator<=(const compensated& a, const compensated& b) { return a.value <= b.value; }
  friend auto operator>(const compensated& a, const compensated& b) { return a.value > b.value; }
  friend auto operator>=(const compensated& a, const compensated& b) { return a.value >= b.value; }
  friend auto operator==(const compensated& a, const compensated& b) { return a.value == b.value; }
  friend auto operator!=(const compensated& a, const compensated& b) { return a.value != b.value; }
};

}  // namespace examples

namespace nysalt {
/// Its elementary functions are those below.
template <class T>
inline constexpr bool has_functions<examples::compensated<T>> = true;
}  // namespace nysalt

namespace examples {

/// a where the condition holds, else b, carries included.
template <class T>
compensated<T> select(const auto& condition, const compensated<T>& a, const compensated<T>& b) {
  compensated<T> result;
  result.value = select(condition, a.value, b.value);
  result.carry = select(condition, a.carry, b.carry);
  return result;
}

// Elementary functions: those of the value.
template <class T>
compensated<T> sqrt(const compensated<T>& a) {
  using std::sqrt;
  return T(sqrt(a.value));
}
template <class T>
compensated<T> exp(const compensated<T>& a) {
  using std::exp;
  return T(exp(a.value));
}
template <class T>
compensated<T> expm1(const compensated<T>& a) {
  using std::expm1;
  return T(expm1(a.value));
}
template <class T>
compensated<T> log(const compensated<T>& a) {
  using std::log;
  return T(log(a.value));
}
template <class T>
compensated<T> sin(const compensated<T>& a) {
  using std::sin;
  return T(sin(a.value));
}
template <class T>
compensated<T> cos(const compensated<T>& a) {
  using std::cos;
  return T(cos(a.value));
}
template <class T>
compensated<T> tan(const compensated<T>& a) {
  using std::tan;
  return T(tan(a.value));
}
template <class T>
compensated<T> atan(const compensated<T>& a) {
  using std::atan;
  return T(atan(a.value));
}
template <class T>
compensated<T> sinh(const compensated<T>& a) {
  using std::sinh;
  return T(sinh(a.value));
}
template <class T>
compensated<T> cosh(const compensated<T>& a) {
  using std::cosh;
  return T(cosh(a.value));
}
template <class T>
compensated<T> tanh(const compensated<T>& a) {
  using std::tanh;
  return T(tanh(a.value));
}
template <class T>
compensated<T> abs(const compensated<T>& a) {
  using std::abs;
  return T(abs(a.value));
}
/// Inverse sine of the value.
template <class T>
compensated<T> asin(const compensated<T>& a) {
  using std::asin;
  return T(asin(a.value));
}
/// Inverse cosine of the value.
template <class T>
compensated<T> acos(const compensated<T>& a) {
  using std::acos;
  return T(acos(a.value));
}
/// Cube root of the value.
template <class T>
compensated<T> cbrt(const compensated<T>& a) {
  using std::cbrt;
  return T(cbrt(a.value));
}
/// Error function of the value.
template <class T>
compensated<T> erf(const compensated<T>& a) {
  using std::erf;
  return T(erf(a.value));
}
/// Largest whole number up to the value.
template <class T>
compensated<T> floor(const compensated<T>& a) {
  using std::floor;
  return T(floor(a.value));
}
/// Angle of (x, y) of the values.
template <class T>
compensated<T> atan2(const compensated<T>& a, const compensated<T>& b) {
  using std::atan2;
  return T(atan2(a.value, b.value));
}
/// sqrt(x^2 + y^2), without overflow of the values.
template <class T>
compensated<T> hypot(const compensated<T>& a, const compensated<T>& b) {
  using std::hypot;
  return T(hypot(a.value, b.value));
}
/// Remainder a - b floor(a/b) of the values.
template <class T>
compensated<T> mod(const compensated<T>& a, const compensated<T>& b) {
  return T(mod(a.value, b.value));
}
/// Power of two arguments of the values.
template <class T>
compensated<T> pow(const compensated<T>& a, const compensated<T>& b) {
  using std::pow;
  return T(pow(a.value, b.value));
}
/// Power of the value; the exponent is a constant.
template <class T>
compensated<T> pow(const compensated<T>& a, double exponent) {
  using std::pow;
  return T(pow(a.value, exponent));
}

}  // namespace examples

namespace Eigen {
/// Lets Eigen store compensated numbers in vectors.
template <class T>
struct NumTraits<examples::compensated<T>> : NumTraits<double> {
  using Real = examples::compensated<T>;
  using NonInteger = examples::compensated<T>;
  using Nested = examples::compensated<T>;
  using Literal = double;
  enum { RequireInitialization = 1, ReadCost = 2, AddCost = 1, MulCost = 1 };
};
/// Lets a user write `f = -2.0 * q`.
template <class T, class Operation>
struct ScalarBinaryOpTraits<double, examples::compensated<T>, Operation> {
  using ReturnType = examples::compensated<T>;
};
template <class T, class Operation>
struct ScalarBinaryOpTraits<examples::compensated<T>, double, Operation> {
  using ReturnType = examples::compensated<T>;
};
}  // namespace Eigen
