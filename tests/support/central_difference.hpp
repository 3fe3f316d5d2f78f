// SPDX-License-Identifier: BSL-1.0
// The slope of a function by differences, and how far it may be off.
#pragma once

#include <cmath>

namespace nysalt::test {

/// Of f at x along coordinate k: (f(x + s e_k) - f(x - s e_k))/(2 s).
template <class F, class X, class K>
class central_difference {
 public:
  central_difference(const F& f, const X& x, K k) : f_(f), x_(x), k_(k) {}

  double operator()(double s) const {
    X ahead = x_;
    X behind = x_;
    ahead[k_] += s;
    behind[k_] -= s;
    return (f_(ahead) - f_(behind)) / (2.0 * s);
  }
  /// Truncation falls to a quarter with s, so it is a third of the change.
  double truncation(double s) const { return std::abs((*this)(s) - (*this)(2.0 * s)) / 3.0; }

 private:
  F f_;
  X x_;
  K k_;
};

}  // namespace nysalt::test
