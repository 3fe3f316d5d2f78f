// SPDX-License-Identifier: BSL-1.0
// The potential of a pair of atoms as a function of the square of their distance, and its derivatives.
#pragma once

#include <array>
#include <cstddef>
#include <type_traits>

#include "exact_sum.hpp"

namespace nysalt::detail {

/// f(std::integral_constant<int, smoothness>), smoothness being from 0 to 3.
void with_smoothness(int smoothness, const auto& f) {
  switch (smoothness) {
    case 0:
      return f(std::integral_constant<int, 0>());
    case 1:
      return f(std::integral_constant<int, 1>());
    case 2:
      return f(std::integral_constant<int, 2>());
    default:
      return f(std::integral_constant<int, 3>());
  }
}

/// With x = r^2, u(x) = 4 (x^-6 - x^-3) and T its Taylor polynomial around x_c. Ways d and squares of
/// distances are in units of the side L of a box, all else in those of the pair. Not cut off.
class lennard_jones_pair {
 public:
  static constexpr int smoothest = 3;

  lennard_jones_pair(double side, double cutoff, int smoothness)
      : limit((cutoff / side) * (cutoff / side)),
        side_(side),
        square_(side * side),
        inverse_square_(1.0 / (side * side)),
        nearest_((nearest / side) * (nearest / side)),
        cutoff_square_(cutoff * cutoff) {
    const double y = 1.0 / cutoff_square_;
    const double y3 = y * y * y;
    // u^(m)/m! = (-1)^m 4 (C(5 + m, m) x^-6 - C(2 + m, m) x^-3) x^-m
    constexpr std::array<double, 4> of_sixth{1.0, 6.0, 21.0, 56.0};
    constexpr std::array<double, 4> of_third{1.0, 3.0, 6.0, 10.0};
    double power = 4.0;
    for (std::size_t m = 0; m <= static_cast<std::size_t>(smoothness); ++m, power *= -y) {
      taylor_[m] = (of_sixth[m] * y3 - of_third[m]) * y3 * power;
    }
  }

  /// Below this square of a distance pairs count.
  double limit;

  /// 1/x
  [[gnu::always_inline]] reals inverse(const reals& square) const { return inverse_square_ / square; }
  /// u - T
  template <int Smoothness>
  [[gnu::always_inline]] reals energy(const reals& square, const reals& y) const {
    const reals y3 = y * y * y;
    return forbidden(square, (y3 - 1.0) * y3 * 4.0 - polynomial<Smoothness, 0>(square));
  }
  /// By which d is multiplied for the force on an atom, d being the way to it: -2 (u' - T') L.
  template <int Smoothness>
  [[gnu::always_inline]] reals push(const reals& square, const reals& y) const {
    const reals y3 = y * y * y;
    reals result = (y3 * (48.0 * side_) - (24.0 * side_)) * (y3 * y);
    if constexpr (Smoothness > 0) result += polynomial<Smoothness, 1>(square) * (2.0 * side_);
    return forbidden(square, result);
  }
  struct pushes {
    reals push;   ///< -2 (u' - T')
    reals slope;  ///< -4 (u'' - T'') L^2
  };
  /// With w the difference of the velocities, f changes by push w + slope (d w) d.
  template <int Smoothness>
  [[gnu::always_inline]] pushes push_and_slope(const reals& square, const reals& y) const {
    const reals y3 = y * y * y;
    const reals y4 = y3 * y;
    pushes result{(y3 * 48.0 - 24.0) * y4, (192.0 - y3 * 672.0) * (y4 * y) * square_};
    if constexpr (Smoothness > 0) result.push += polynomial<Smoothness, 1>(square) * 2.0;
    if constexpr (Smoothness > 1) result.slope += polynomial<Smoothness, 2>(square) * (4.0 * square_);
    result.push = forbidden(square, result.push);
    return result;
  }

 private:
  /// Nearer ones push with more than sums hold: 48/r^13 = 3.2e9 of 4.3e9.
  static constexpr double nearest = 0.25;

  /// Not a number where atoms are too near.
  reals forbidden(const reals& square, const reals& x) const {
    return reinterpret_cast<reals>(reinterpret_cast<integers>(x) | integers(square < nearest_));
  }
  /// The derivative of T of that order.
  template <int Smoothness, int Order>
  [[gnu::always_inline]] reals polynomial(const reals& square) const {
    const reals x = square * square_ - cutoff_square_;
    reals sum = all_lanes(factor(Smoothness, Order) * taylor_[Smoothness]);
    for (int m = Smoothness - 1; m >= Order; --m) {
      sum = sum * x + factor(m, Order) * taylor_[static_cast<std::size_t>(m)];
    }
    return sum;
  }
  /// m (m - 1) ... of `order` factors
  static constexpr double factor(int m, int order) {
    double result = 1.0;
    for (int k = 0; k < order; ++k) result *= m - k;
    return result;
  }

  double side_;
  double square_;
  double inverse_square_;
  double nearest_;
  double cutoff_square_;
  std::array<double, 4> taylor_{};
};

}  // namespace nysalt::detail
