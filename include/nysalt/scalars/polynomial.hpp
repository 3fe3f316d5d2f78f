// SPDX-License-Identifier: BSL-1.0
// Polynomials by coefficients of powers, and by Bernstein coefficients, between which their values lie.
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

// Polynomials of any degree in powers of one variable.

namespace nysalt::detail {

/// sum_k coefficient[k] x^k of any degree.
struct dense_polynomial {
  std::vector<double> coefficient;

  dense_polynomial times_x() const {
    dense_polynomial result{{0.0}};
    result.coefficient.insert(result.coefficient.end(), coefficient.begin(), coefficient.end());
    return result;
  }
  dense_polynomial& operator+=(const dense_polynomial& b) {
    coefficient.resize(std::max(coefficient.size(), b.coefficient.size()));
    for (std::size_t k = 0; k < b.coefficient.size(); ++k) coefficient[k] += b.coefficient[k];
    return *this;
  }
  dense_polynomial& operator*=(double c) {
    for (double& a : coefficient) a *= c;
    return *this;
  }
  friend dense_polynomial operator*(double c, dense_polynomial a) { return a *= c; }

  /// The value at x, divided by x^first, without the terms below x^first.
  double tail(std::size_t first, double x) const {
    double sum = 0.0;
    for (std::size_t k = coefficient.size(); k-- > first;) sum = sum * x + coefficient[k];
    return sum;
  }
};

}  // namespace nysalt::detail

// Polynomials on an interval by coefficients between which they lie.

namespace nysalt {

namespace detail {

/// sum_i c_i (n over i) t^i (1 - t)^{n - i} with x = low + t (high - low): its values on the interval lie
/// between the least and the largest c_i, and c_0 and c_n are those at the ends. Sums, products with x and
/// halves are convex combinations, so nothing cancels that does not cancel in the values.
/// Cost: of all operations n, of halves n^2/2.
class bernstein_polynomial {
 public:
  /// A constant on [low, high].
  bernstein_polynomial(double low, double high, double constant) : low_(low), high_(high), c_{constant} {}

  double low() const { return low_; }           ///< lower end of the interval
  double high() const { return high_; }         ///< upper end of the interval
  double at_low() const { return c_.front(); }  ///< the value at low()
  double at_high() const { return c_.back(); }  ///< the value at high()
  /// The least and the largest coefficient: no value on the interval lies outside them.
  std::pair<double, double> bounds() const {
    const auto [least, most] = std::minmax_element(c_.begin(), c_.end());
    return {*least, *most};
  }
  /// Number of sign changes of the differences of neighbouring coefficients: the derivative has as many roots
  /// inside the interval, or fewer by an even number [farouki_2012]. Differences within `rounding` of the
  /// larger of both coefficients are left out.
  int turns(double rounding) const;

  /// The sum, of the higher degree of both; b must be on the same interval.
  bernstein_polynomial& operator+=(bernstein_polynomial b);
  /// Multiplies the values by a.
  bernstein_polynomial& operator*=(double a) {
    for (double& c : c_) c *= a;
    return *this;
  }
  /// The polynomial whose values are a b(x).
  friend bernstein_polynomial operator*(double a, bernstein_polynomial b) { return b *= a; }

  bernstein_polynomial times_x() const { return times_linear(low_, high_); }  ///< x f(x), of one degree more

  /// On the lower and on the upper half of the interval [farouki_2012].
  std::pair<bernstein_polynomial, bernstein_polynomial> halves() const;

 private:
  /// Times the line from a to b.
  bernstein_polynomial times_linear(double a, double b) const;
  void elevate() { c_ = times_linear(1.0, 1.0).c_; }

  double low_;
  double high_;
  std::vector<double> c_;
};

/// Some x where |f| exceeds the bound, and nothing if there is none. Halves of the interval are decided by
/// their coefficients; those that are undecided after 40 halvings only touch the bound. A polynomial that is
/// not a number exceeds every bound.
std::optional<double> where_larger(const bernstein_polynomial& f, double bound, int halvings = 40);

}  // namespace detail

}  // namespace nysalt
