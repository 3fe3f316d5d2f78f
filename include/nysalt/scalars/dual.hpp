// SPDX-License-Identifier: BSL-1.0
// Forward derivatives: a value and its N first derivatives, computed together.
#pragma once

#include <Eigen/Core>

#include <array>
#include <cmath>
#include <concepts>
#include <numbers>

#include "nysalt/scalar.hpp"

namespace nysalt {

/// value + sum_k derivative[k] e_k with e_j e_k = 0. T may itself be a dual (second derivatives).
/// Cost: an operation on dual<T, N> is N + 1 (sums) to 3 N + 1 (products, quotients) operations on T.
template <Scalar T, int N>
struct dual {
  using value_type = T;                  ///< type of the value, possibly a dual number or a pack
  static constexpr int derivatives = N;  ///< number of derivatives

  T value{};                      ///< value of the function
  std::array<T, N> derivative{};  ///< derivatives of the function by each variable

  dual() = default;
  /// A constant: all derivatives are 0.
  dual(double constant) : value(constant) { derivative.fill(T(0.0)); }
  dual(const T& constant)
    requires(!std::same_as<T, double>)
      : value(constant) {
    derivative.fill(T(0.0));
  }

  /// The k-th independent variable at x: its derivative is e_k.
  static dual variable(const T& x, int k) {
    dual result(x);
    result.derivative[static_cast<std::size_t>(k)] = T(1.0);
    return result;
  }

  [[gnu::always_inline]] dual& operator+=(const dual& b) { return *this = *this + b; }
  [[gnu::always_inline]] dual& operator-=(const dual& b) { return *this = *this - b; }
  [[gnu::always_inline]] dual& operator*=(const dual& b) { return *this = *this * b; }
  [[gnu::always_inline]] dual& operator/=(const dual& b) { return *this = *this / b; }

  // Always inlined: a call would pass all numbers of a dual over packs through memory.
  [[gnu::always_inline]] friend dual operator+(const dual& a, const dual& b) {
    dual result;
    result.value = a.value + b.value;
    for (std::size_t k = 0; k < N; ++k) {
      result.derivative[k] = a.derivative[k] + b.derivative[k];
    }
    return result;
  }
  [[gnu::always_inline]] friend dual operator-(const dual& a, const dual& b) {
    dual result;
    result.value = a.value - b.value;
    for (std::size_t k = 0; k < N; ++k) {
      result.derivative[k] = a.derivative[k] - b.derivative[k];
    }
    return result;
  }
  [[gnu::always_inline]] friend dual operator*(const dual& a, const dual& b) {
    dual result;
    result.value = a.value * b.value;
    for (std::size_t k = 0; k < N; ++k) {
      result.derivative[k] = a.derivative[k] * b.value + a.value * b.derivative[k];
    }
    return result;
  }
  [[gnu::always_inline]] friend dual operator/(const dual& a, const dual& b) {
    const T quotient = a.value / b.value;
    dual result;
    result.value = quotient;
    for (std::size_t k = 0; k < N; ++k) {
      result.derivative[k] = (a.derivative[k] - quotient * b.derivative[k]) / b.value;
    }
    return result;
  }
  [[gnu::always_inline]] friend dual operator-(const dual& a) {
    dual result;
    result.value = -a.value;
    for (std::size_t k = 0; k < N; ++k) {
      result.derivative[k] = -a.derivative[k];
    }
    return result;
  }

  // With constants, which have no derivatives to carry.
  [[gnu::always_inline]] friend dual operator+(dual a, double c) {
    a.value += c;
    return a;
  }
  [[gnu::always_inline]] friend dual operator+(double c, const dual& a) { return a + c; }
  [[gnu::always_inline]] friend dual operator-(dual a, double c) {
    a.value -= c;
    return a;
  }
  [[gnu::always_inline]] friend dual operator-(double c, const dual& a) {
    dual result;
    result.value = c - a.value;
    for (std::size_t k = 0; k < N; ++k) {
      result.derivative[k] = -a.derivative[k];
    }
    return result;
  }
  [[gnu::always_inline]] friend dual operator*(const dual& a, double c) {
    dual result;
    result.value = a.value * c;
    for (std::size_t k = 0; k < N; ++k) {
      result.derivative[k] = a.derivative[k] * c;
    }
    return result;
  }
  [[gnu::always_inline]] friend dual operator*(double c, const dual& a) { return a * c; }
  // Not times 1/c, which rounds twice.
  [[gnu::always_inline]] friend dual operator/(const dual& a, double c) {
    dual result;
    result.value = a.value / c;
    for (std::size_t k = 0; k < N; ++k) {
      result.derivative[k] = a.derivative[k] / c;
    }
    return result;
  }
  [[gnu::always_inline]] friend dual operator/(double c, const dual& a) { return dual(c) / a; }

  // Numbers are ordered by their values: a branch is taken as it would be without derivatives.
  friend auto operator<(const dual& a, const dual& b) { return a.value < b.value; }
  friend auto operator<=(const dual& a, const dual& b) { return a.value <= b.value; }
  friend auto operator>(const dual& a, const dual& b) { return a.value > b.value; }
  friend auto operator>=(const dual& a, const dual& b) { return a.value >= b.value; }
  friend auto operator==(const dual& a, const dual& b) { return a.value == b.value; }
  friend auto operator!=(const dual& a, const dual& b) { return a.value != b.value; }

  /// f(a) from f(a.value) and f'(a.value).
  [[gnu::always_inline]] dual chain(const T& f, const T& slope) const {
    dual result;
    result.value = f;
    for (std::size_t k = 0; k < N; ++k) {
      result.derivative[k] = slope * derivative[k];
    }
    return result;
  }
};

/// a where the condition holds, else b: what a branch is for scalars that may differ from lane to lane.
template <class T, int N>
dual<T, N> select(const auto& condition, const dual<T, N>& a, const dual<T, N>& b) {
  dual<T, N> result;
  result.value = select(condition, a.value, b.value);
  for (std::size_t k = 0; k < N; ++k) {
    result.derivative[k] = select(condition, a.derivative[k], b.derivative[k]);
  }
  return result;
}

namespace detail {

/// Whether a type is dual<T, N> for some T and N.
template <class T>
inline constexpr bool is_dual = false;
template <class T, int N>
inline constexpr bool is_dual<dual<T, N>> = true;  ///< a dual is one

}  // namespace detail
template <class T, int N>
inline constexpr bool has_functions<dual<T, N>> = true;  ///< below

// Elementary functions: unqualified calls find libm for double and these for duals.
/// (sqrt a)' = a'/(2 sqrt a), which is not finite at 0.
template <class T, int N>
dual<T, N> sqrt(const dual<T, N>& a) {
  using std::sqrt;
  const T root = sqrt(a.value);
  return a.chain(root, T(0.5) / root);
}
template <class T, int N>
dual<T, N> exp(const dual<T, N>& a) {
  using std::exp;
  const T value = exp(a.value);
  return a.chain(value, value);
}
/// e^a - 1, accurate near 0.
template <class T, int N>
dual<T, N> expm1(const dual<T, N>& a) {
  using std::exp;
  using std::expm1;
  return a.chain(expm1(a.value), exp(a.value));
}
template <class T, int N>
dual<T, N> log(const dual<T, N>& a) {
  using std::log;
  return a.chain(log(a.value), T(1.0) / a.value);
}
template <class T, int N>
dual<T, N> sin(const dual<T, N>& a) {
  using std::cos;
  using std::sin;
  return a.chain(sin(a.value), cos(a.value));
}
template <class T, int N>
dual<T, N> cos(const dual<T, N>& a) {
  using std::cos;
  using std::sin;
  return a.chain(cos(a.value), -sin(a.value));
}
template <class T, int N>
dual<T, N> tan(const dual<T, N>& a) {
  using std::tan;
  const T value = tan(a.value);
  return a.chain(value, T(1.0) + value * value);
}
/// (asin a)' = a'/sqrt(1 - a^2), which is not finite at -1 and 1.
template <class T, int N>
dual<T, N> asin(const dual<T, N>& a) {
  using std::asin;
  using std::sqrt;
  return a.chain(asin(a.value), T(1.0) / sqrt((T(1.0) - a.value) * (T(1.0) + a.value)));
}
/// (acos a)' = -a'/sqrt(1 - a^2), which is not finite at -1 and 1.
template <class T, int N>
dual<T, N> acos(const dual<T, N>& a) {
  using std::acos;
  using std::sqrt;
  return a.chain(acos(a.value), T(-1.0) / sqrt((T(1.0) - a.value) * (T(1.0) + a.value)));
}
template <class T, int N>
dual<T, N> atan(const dual<T, N>& a) {
  using std::atan;
  return a.chain(atan(a.value), T(1.0) / (T(1.0) + a.value * a.value));
}
template <class T, int N>
dual<T, N> sinh(const dual<T, N>& a) {
  using std::cosh;
  using std::sinh;
  return a.chain(sinh(a.value), cosh(a.value));
}
template <class T, int N>
dual<T, N> cosh(const dual<T, N>& a) {
  using std::cosh;
  using std::sinh;
  return a.chain(cosh(a.value), sinh(a.value));
}
template <class T, int N>
dual<T, N> tanh(const dual<T, N>& a) {
  using std::tanh;
  const T value = tanh(a.value);
  return a.chain(value, T(1.0) - value * value);
}
/// Angle of (x, y), in all quadrants. The derivative is not finite at the origin.
template <class T, int N>
dual<T, N> atan2(const dual<T, N>& y, const dual<T, N>& x) {
  using std::atan2;
  using std::hypot;
  const T radius = hypot(y.value, x.value);
  const T by_y = x.value / radius / radius;
  const T by_x = -y.value / radius / radius;
  dual<T, N> result;
  result.value = atan2(y.value, x.value);
  for (std::size_t k = 0; k < N; ++k) {
    result.derivative[k] = by_y * y.derivative[k] + by_x * x.derivative[k];
  }
  return result;
}
/// sqrt(x^2 + y^2), without overflow. The derivative at the origin, where there is none, is 0.
template <class T, int N>
dual<T, N> hypot(const dual<T, N>& x, const dual<T, N>& y) {
  using std::hypot;
  const T radius = hypot(x.value, y.value);
  const T by_x = select(radius > 0.0, x.value / radius, T(0.0));
  const T by_y = select(radius > 0.0, y.value / radius, T(0.0));
  dual<T, N> result;
  result.value = radius;
  for (std::size_t k = 0; k < N; ++k) {
    result.derivative[k] = by_x * x.derivative[k] + by_y * y.derivative[k];
  }
  return result;
}
/// (cbrt a)' = a'/(3 (cbrt a)^2), which is not finite at 0.
template <class T, int N>
dual<T, N> cbrt(const dual<T, N>& a) {
  using std::cbrt;
  const T root = cbrt(a.value);
  return a.chain(root, T(1.0) / (root * root * 3.0));
}
/// (erf a)' = 2 exp(-a^2) a'/sqrt(pi).
template <class T, int N>
dual<T, N> erf(const dual<T, N>& a) {
  using std::erf;
  using std::exp;
  return a.chain(erf(a.value), exp(-(a.value * a.value)) * (2.0 * std::numbers::inv_sqrtpi));
}
/// The derivative is 0, at jumps too.
template <class T, int N>
dual<T, N> floor(const dual<T, N>& a) {
  using std::floor;
  return T(floor(a.value));
}
/// Remainder a - b floor(a/b); its derivative is a' - floor(a/b) b', at jumps too.
template <class T, int N>
dual<T, N> mod(const dual<T, N>& a, const dual<T, N>& b) {
  using std::floor;
  dual<T, N> result;
  result.value = mod(a.value, b.value);
  const T quotient = floor((a.value - result.value) / b.value + T(0.5));  // whole but for rounding
  for (std::size_t k = 0; k < N; ++k) result.derivative[k] = a.derivative[k] - quotient * b.derivative[k];
  return result;
}
/// (a^b)' = b a^(b - 1) a' + log(a) a^b b'. For a <= 0, where the second term is not defined, it is 0.
template <class T, int N>
dual<T, N> pow(const dual<T, N>& a, const dual<T, N>& b) {
  using std::log;
  using std::pow;
  dual<T, N> result;
  result.value = pow(a.value, b.value);
  const T by_a = select(b.value == 0.0, T(0.0), b.value * pow(a.value, b.value - 1.0));
  const T by_b = select(a.value > 0.0, log(a.value) * result.value, T(0.0));
  for (std::size_t k = 0; k < N; ++k) {
    result.derivative[k] = by_a * a.derivative[k] + by_b * b.derivative[k];
  }
  return result;
}
/// (a^c)' = c a^(c - 1) a'; the exponent is a constant.
template <class T, int N>
dual<T, N> pow(const dual<T, N>& a, double exponent) {
  using std::pow;
  const T slope = exponent == 0.0 ? T(0.0) : T(exponent * pow(a.value, exponent - 1.0));
  return a.chain(pow(a.value, exponent), slope);
}
/// Absolute value. The derivative at 0 is taken from the right.
template <class T, int N>
dual<T, N> abs(const dual<T, N>& a) {
  return select(a.value < 0.0, -a, a);
}

}  // namespace nysalt

namespace Eigen {
/// Lets Eigen store dual numbers in vectors and matrices.
template <class T, int N>
struct NumTraits<nysalt::dual<T, N>> : NumTraits<double> {
  using Real = nysalt::dual<T, N>;
  using NonInteger = nysalt::dual<T, N>;
  using Nested = nysalt::dual<T, N>;
  using Literal = double;
  enum { RequireInitialization = 1, ReadCost = N + 1, AddCost = N + 1, MulCost = 2 * N + 1 };
};
/// Lets a user write `f = -2.0 * q`.
template <class T, int N, class Operation>
struct ScalarBinaryOpTraits<double, nysalt::dual<T, N>, Operation> {
  using ReturnType = nysalt::dual<T, N>;
};
template <class T, int N, class Operation>
struct ScalarBinaryOpTraits<nysalt::dual<T, N>, double, Operation> {
  using ReturnType = nysalt::dual<T, N>;
};
}  // namespace Eigen
