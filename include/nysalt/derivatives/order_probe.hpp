// SPDX-License-Identifier: BSL-1.0
// A generic system whose flow is known as a power series, on which orders are measured.
#pragma once

#include <array>
#include <cstdint>
#include <random>

#include "nysalt/scalars/series.hpp"
#include "nysalt/system.hpp"

namespace nysalt {

/// Orders are distinguished up to this one, which means "this or more".
inline constexpr int highest_taylor_order = 10;

/// A power series in the step h.
using taylor = series<highest_taylor_order>;

/// Fixed numbers in general position between 1/4 and 1.
class generic_numbers {
 public:
  /// The next number.
  double next() {  // the standard's distributions differ between libraries, its bits do not
    return 0.25 + 0.75 * (static_cast<double>(bits_() >> 11U) * 0x1p-53);
  }

 private:
  std::mt19937_64 bits_;
};

/// x -> sum_j a_j P_j(a_j . x), the gradient of a generic polynomial: more directions a_j than coordinates,
/// so that nothing separates, and P_j of so high a degree that no derivative vanishes which the series up to
/// the highest order contains.
class generic_gradient {
 public:
  /// Takes its directions and polynomials from the next 56 numbers.
  explicit generic_gradient(generic_numbers& numbers) {
    for (auto& [direction, polynomial] : ridges_) {
      for (double& a : direction) a = numbers.next();
      double factorial = 1.0;
      for (std::size_t m = 0; m < polynomial.size(); ++m) {
        if (m > 0) factorial *= static_cast<double>(m);
        polynomial[m] = numbers.next() / factorial;
      }
    }
  }

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
  explicit order_probe(bool quadratic_kinetic) : quadratic_kinetic_(quadratic_kinetic) {
    for (double& q : start_.q) q = numbers_.next();
    for (double& p : start_.p) p = numbers_.next();
  }

  /// -h grad V(q), a series in h.
  template <class T>
  void force(const vector<T, 3>& q, vector<T, 3>& f) const {
    potential_gradient_(q, f);
    for (T& entry : f) entry = entry * -taylor::variable();
  }
  /// h grad K(p), a series in h.
  template <class T>
  void velocity(const vector<T, 3>& p, vector<T, 3>& v) const {
    v = p;
    if (!quadratic_kinetic_) kinetic_gradient_(p, v);
    for (T& entry : v) entry = entry * taylor::variable();
  }

  phase_point<taylor, 3> start() const { return start_.cast<taylor>(); }  ///< generic q and p, constant in h

  /// The flow over the time h, by Picard's iteration x <- start + integral of x': each sweep gains
  /// an order. As the series holds h x', integration divides the k-th coefficient by k.
  phase_point<taylor, 3> flow() const {
    auto x = start();
    auto v = x.p;
    auto f = x.q;
    for (int sweep = 0; sweep < highest_taylor_order; ++sweep) {
      velocity(x.p, v);
      force(x.q, f);
      integrate(v, x.q);
      integrate(f, x.p);
    }
    return x;
  }

 private:
  static void integrate(const vector<taylor, 3>& rate, vector<taylor, 3>& x) {
    for (Eigen::Index i = 0; i < 3; ++i) {
      for (std::size_t k = 1; k < taylor::terms; ++k) {
        x[i].coefficient[k] = rate[i].coefficient[k] / static_cast<double>(k);
      }
    }
  }

  generic_numbers numbers_;
  generic_gradient potential_gradient_{numbers_};
  generic_gradient kinetic_gradient_{numbers_};
  bool quadratic_kinetic_;
  phase_point<double, 3> start_;
};

}  // namespace nysalt
