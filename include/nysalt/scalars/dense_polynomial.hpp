// SPDX-License-Identifier: BSL-1.0
// Polynomials of any degree in powers of one variable.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

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
