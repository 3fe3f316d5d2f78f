// SPDX-License-Identifier: BSL-1.0
// The order of a method, exactly: where the Taylor expansion of one step leaves the expansion of the flow.
#pragma once

#include <array>
#include <functional>
#include <random>
#include <vector>

#include "nysalt/method.hpp"
#include "nysalt/phase_point.hpp"
#include "nysalt/scalars/series.hpp"
#include "nysalt/word.hpp"

namespace nysalt {

// A generic system whose flow is known as a power series, on which orders are measured.

namespace detail {

/// Orders are distinguished up to this one, which means "this or more".
inline constexpr int highest_taylor_order = 10;

/// A power series in the step h.
using taylor = series<highest_taylor_order>;

/// x -> sum_j a_j P_j(a_j . x), the gradient of a generic polynomial: more directions a_j than coordinates,
/// so that nothing separates, and P_j of so high a degree that no derivative vanishes which the series up to
/// the highest order contains.
class generic_gradient {
 public:
  /// Takes its directions and polynomials from the next 56 numbers between 1/4 and 1.
  explicit generic_gradient(std::mt19937_64& bits);

  /// The gradient at x into `result`, over any scalar T.
  template <class T>
  void operator()(const vector<T, 3>& x, vector<T, 3>& result) const {
    for (T& entry : result) entry = T(0.0);
    for (const auto& [direction, polynomial] : ridges_) {
      const T along = x[0] * direction[0] + x[1] * direction[1] + x[2] * direction[2];
      T value(polynomial.back());
      for (std::size_t m = polynomial.size() - 1; m-- > 0;) value = value * along + T(polynomial[m]);
      for (Eigen::Index i = 0; i < 3; ++i) result[i] += value * direction[static_cast<std::size_t>(i)];
    }
  }

 private:
  struct ridge {
    std::array<double, 3> direction;
    std::array<double, highest_taylor_order + 1> polynomial;
  };
  std::array<ridge, 4> ridges_;
};

/// H = h (K(p) + V(q)) with the variable h of the series: a step of length 1 is the expansion of a step h.
/// K is p.p/2 or generic. Three degrees of freedom: with one, orders hold by accident from the fifth on.
class order_probe {
 public:
  static constexpr int dimension = 3;  ///< degrees of freedom
  /// Decided at run time, see HasQuadraticKinetic.
  static constexpr bool may_have_quadratic_kinetic = true;

  /// K = p.p/2 if quadratic_kinetic, else a generic polynomial. Always the same V and start.
  explicit order_probe(bool quadratic_kinetic);

  /// -h grad V(q), a series in h; over numbers, which letters may ask for, h = 1.
  template <class T>
  void force(const vector<T, 3>& q, vector<T, 3>& f) const {
    potential_gradient_(q, f);
    for (T& entry : f) entry = entry * -step<T>();
  }
  /// h grad K(p), a series in h; over numbers h = 1.
  template <class T>
  void velocity(const vector<T, 3>& p, vector<T, 3>& v) const {
    v = p;
    if (!quadratic_kinetic_) kinetic_gradient_(p, v);
    for (T& entry : v) entry = entry * step<T>();
  }

  phase_point<taylor, 3> start() const { return start_.cast<taylor>(); }  ///< generic q and p, constant in h

  /// The flow over the time h, by Picard's iteration x <- start + integral of x': each sweep gains
  /// an order. As the series holds h x', integration divides the k-th coefficient by k.
  phase_point<taylor, 3> flow() const;

 private:
  template <class T>
  static auto step() {
    if constexpr (requires(T x) { x = x * taylor::variable(); }) {  // a series, or derivatives of series
      return taylor::variable();
    } else {
      return T(1.0);
    }
  }

  std::mt19937_64 bits_;
  generic_gradient potential_gradient_{bits_};
  generic_gradient kinetic_gradient_{bits_};
  bool quadratic_kinetic_;
  phase_point<double, 3> start_;
};

}  // namespace detail

/// The orders of a method where K = p M^-1 p / 2, and where K(p) may be anything. 0: not consistent;
/// highest_taylor_order: this or more.
struct taylor_orders {
  int quadratic_kinetic;  ///< the order where K is quadratic in p
  int any_kinetic;        ///< the order for every K(p)
  friend bool operator==(const taylor_orders&, const taylor_orders&) = default;  ///< equal in both
};

namespace detail {

/// A composition of any kind: the state after a step of length 1 from start() of the system, with
/// coefficients.
using composition_step =
    std::function<phase_point<taylor, 3>(const order_probe& system, const std::vector<double>& coefficients)>;

/// The orders of a composition of any kind.
taylor_orders taylor_order_of(const std::vector<double>& coefficients, const composition_step& one_step);

}  // namespace detail

/// The orders of a word with coefficients that are known to ten decimals: one step on a generic system, and
/// its flow, are expanded in powers of h and compared. Cost: as many steps in series as there are letters,
/// some 2 ms for 23. The error of n steps of a processed word is the error of P(-h) K^n P(h)^-1: it is the
/// least order of one step and of none.
///
/// Words with rotations obey the order conditions of those with drifts: all that these use of K is that it is
/// quadratic in p, and so is K with the quadratic part of V.
taylor_orders taylor_order(const nysalt::word& word, const std::vector<double>& coefficients);

/// The orders of a method, at its own coefficients.
inline taylor_orders taylor_order(const nysalt::method& method) {
  return taylor_order(method.letters(), method.coefficients());
}

}  // namespace nysalt
