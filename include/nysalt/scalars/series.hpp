// SPDX-License-Identifier: BSL-1.0
// Polynomials in one variable, cut off beyond a degree: a step taken with them is a Taylor expansion.
#pragma once

#include <Eigen/Core>

#include <array>

#include "nysalt/scalar.hpp"

namespace nysalt {

/// sum_k coefficient[k] x^k, k = 0..Degree; products drop what lies beyond. A word of n kicks on the
/// oscillator is a polynomial of degree n in z^2, so series<n> gives its stability polynomial exactly.
/// Cost: a product takes (Degree + 1)(Degree + 2)/2 multiplications.
template <int Degree>
struct series {
  static constexpr std::size_t terms = Degree + 1;  ///< number of coefficients kept
  std::array<double, terms> coefficient{};          ///< coefficients, of x^k at k

  series() = default;
  series(double constant) { coefficient[0] = constant; }  ///< series of degree 0

  /// The variable x itself.
  static series variable()
    requires(Degree >= 1)
  {
    series result;
    result.coefficient[1] = 1.0;
    return result;
  }

  series& operator+=(const series& b) {
    for (std::size_t k = 0; k < terms; ++k) coefficient[k] += b.coefficient[k];
    return *this;
  }
  series& operator-=(const series& b) {
    for (std::size_t k = 0; k < terms; ++k) coefficient[k] -= b.coefficient[k];
    return *this;
  }

  series& operator*=(const series& b) { return *this = *this * b; }

  friend series operator+(series a, const series& b) { return a += b; }
  friend series operator-(series a, const series& b) { return a -= b; }
  friend series operator-(const series& a) { return a * -1.0; }
  friend series operator*(const series& a, double c) {
    series result;
    for (std::size_t k = 0; k < terms; ++k) result.coefficient[k] = a.coefficient[k] * c;
    return result;
  }
  friend series operator*(double c, const series& a) { return a * c; }
  friend series operator*(const series& a, const series& b) {
    series result;
    for (std::size_t j = 0; j < terms; ++j) {
      for (std::size_t k = 0; j + k < terms; ++k) {
        result.coefficient[j + k] += a.coefficient[j] * b.coefficient[k];
      }
    }
    return result;
  }
  /// Power series division: b must have a constant term.
  friend series operator/(const series& a, const series& b) {
    series result;
    for (std::size_t k = 0; k < terms; ++k) {
      double rest = a.coefficient[k];
      for (std::size_t j = 0; j < k; ++j) rest -= result.coefficient[j] * b.coefficient[k - j];
      result.coefficient[k] = rest / b.coefficient[0];
    }
    return result;
  }
};

}  // namespace nysalt

namespace Eigen {
template <int Degree>
struct NumTraits<nysalt::series<Degree>> : NumTraits<double> {
  using Real = nysalt::series<Degree>;
  using NonInteger = nysalt::series<Degree>;
  using Nested = nysalt::series<Degree>;
  using Literal = double;
  enum { RequireInitialization = 1, ReadCost = Degree + 1, AddCost = Degree + 1, MulCost = HugeCost };
};
}  // namespace Eigen
