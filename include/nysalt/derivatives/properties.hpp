// SPDX-License-Identifier: BSL-1.0
// What a step is: symplectic, reversible, of an order.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "nysalt/method.hpp"
#include "nysalt/phase_point.hpp"
#include "nysalt/scalars/dual.hpp"
#include "nysalt/scalars/series.hpp"
#include "nysalt/system.hpp"

namespace nysalt {

/// Exact Jacobian of a map of phase space at x, rows and columns ordered (q, p). The map takes a
/// phase_point<dual<double, 1>, N>& and changes it in place. Cost: 2 N evaluations of the map.
template <int N>
Eigen::MatrixXd jacobian(const auto& map, const phase_point<double, N>& x) {
  using D = dual<double, 1>;
  const Eigen::Index n = x.size();
  Eigen::MatrixXd result(2 * n, 2 * n);
  for (Eigen::Index column = 0; column < 2 * n; ++column) {
    auto y = x.template cast<D>();
    (column < n ? y.q[column] : y.p[column - n]).derivative[0] = 1.0;
    map(y);
    for (Eigen::Index i = 0; i < n; ++i) {
      result(i, column) = y.q[i].derivative[0];
      result(n + i, column) = y.p[i].derivative[0];
    }
  }
  return result;
}

/// One plain step of a method as a map of phase space, over any scalar.
template <System S>
auto step_map(const S& system, const tabulated& method, double step) {
  return [stepper = make_stepper(system, method, step)](auto& x) { stepper.step(x); };
}
template <System S>
void step_map(const S&& system, const tabulated& method, double step) = delete;  // it would refer to a temporary

/// Largest entry of J^T Omega J - Omega with the exact Jacobian J of a map at x: zero to rounding if and
/// only if the map is symplectic there [hairer_lubich_wanner_2006, definition VI.2.2].
template <int N>
double symplecticity_defect(const auto& map, const phase_point<double, N>& x) {
  const Eigen::Index n = x.size();
  Eigen::MatrixXd omega = Eigen::MatrixXd::Zero(2 * n, 2 * n);
  omega.topRightCorner(n, n).setIdentity();
  omega.bottomLeftCorner(n, n).diagonal().setConstant(-1.0);
  const Eigen::MatrixXd j = jacobian(map, x);
  return (j.transpose() * omega * j - omega).cwiseAbs().maxCoeff();
}

/// Symplecticity defect of one step of a method.
template <System S>
double symplecticity_defect(const S& system, const tabulated& method, double step,
                            const phase_point<double, S::dimension>& x) {
  return symplecticity_defect(step_map(system, method, step), x);
}

/// Largest coordinate of R Phi R Phi(x) - x with R(q, p) = (q, -p): zero to rounding for reversible maps
/// [hairer_lubich_wanner_2006, definition V.1.2].
template <int N>
double reversibility_defect(const auto& map, const phase_point<double, N>& x) {
  auto y = x;
  for (int half = 0; half < 2; ++half) {
    map(y);
    y.p = (-y.p).eval();
  }
  return std::max((y.q - x.q).cwiseAbs().maxCoeff(), (y.p - x.p).cwiseAbs().maxCoeff());
}

/// Reversibility defect of one step of a method.
template <System S>
double reversibility_defect(const S& system, const tabulated& method, double step,
                            const phase_point<double, S::dimension>& x) {
  return reversibility_defect(step_map(system, method, step), x);
}

// A generic system whose flow is known as a power series, on which orders are measured.

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

// The order of a method, exactly: where the Taylor expansion of one step leaves that of the flow.

/// The orders of a method where K = p M^-1 p / 2, and where K(p) may be anything. 0: not consistent;
/// highest_taylor_order: this or more.
struct taylor_orders {
  int quadratic_kinetic;  ///< the order where K is quadratic in p
  int any_kinetic;        ///< the order for every K(p)
  friend bool operator==(const taylor_orders&, const taylor_orders&) = default;  ///< equal in both
};

namespace detail {

/// |x - y| coordinate by coordinate, power by power.
inline std::array<taylor, 6> distances(const phase_point<taylor, 3>& x, const phase_point<taylor, 3>& y) {
  std::array<taylor, 6> result{x.q[0] - y.q[0], x.q[1] - y.q[1], x.q[2] - y.q[2],
                               x.p[0] - y.p[0], x.p[1] - y.p[1], x.p[2] - y.p[2]};
  for (taylor& distance : result) {
    for (double& c : distance.coefficient) c = std::abs(c);
  }
  return result;
}

/// Tables are printed to ten digits or more. Hence a power of h agrees if errors of 1e-10 in the coefficients
/// of the letters, at their worst, explain the difference: sum_i |dx/dc_i| 1e-10. This is sharp where large
/// terms cancel, and rounding stays far below: it acts like errors of some 1e-16.
template <class Coefficients>
int order_on(const order_probe& system, Coefficients coefficients, const auto& one_step,
             const phase_point<taylor, 3>& exact) {
  const auto x = one_step(system, coefficients);
  const auto error = distances(x, exact);
  std::array<taylor, 6> tolerance;
  for (double& c : coefficients) {
    const double as_given = c;
    c += 1e-10;
    const auto change = distances(one_step(system, coefficients), x);
    for (std::size_t i = 0; i < 6; ++i) tolerance[i] += change[i];
    c = as_given;
  }
  for (std::size_t k = 1; k < taylor::terms; ++k) {
    for (std::size_t i = 0; i < 6; ++i) {
      const bool agrees = error[i].coefficient[k] <= tolerance[i].coefficient[k];
      if (!agrees) return static_cast<int>(k) - 1;  // nor does what is not a number
    }
  }
  return highest_taylor_order;
}

}  // namespace detail

/// The orders of a composition of any kind. The coefficients are a container of double that can be copied;
/// one_step(system, coefficients) is the phase_point after a step of length 1 from system.start().
template <class Coefficients>
taylor_orders taylor_order_of(const Coefficients& coefficients, const auto& one_step) {
  const order_probe quadratic(true);
  const order_probe any(false);
  return {detail::order_on(quadratic, coefficients, one_step, quadratic.flow()),
          detail::order_on(any, coefficients, one_step, any.flow())};
}

namespace detail {

/// To which powers of h the processor of a word is even, so that P(-h) P(h)^-1 is the identity.
inline taylor_orders order_of_processor(const word& letters, const std::vector<double>& coefficients) {
  const auto there_and_back = [&](const order_probe& system, const std::vector<double>& c) {
    auto x = system.start();
    stepper<order_probe>(system, pre_processor(letters), pre_processor_coefficients(letters, c), 1.0)
        .step(x);
    stepper<order_probe>(system, post_processor(letters), post_processor_coefficients(letters, c),
                                        1.0)
        .step(x);
    return x;
  };
  const order_probe quadratic(true);
  const order_probe any(false);
  return {order_on(quadratic, coefficients, there_and_back, quadratic.start()),
          order_on(any, coefficients, there_and_back, any.start())};
}

}  // namespace detail

/// The orders of a word with coefficients that are known to ten decimals: one step on a generic system, and
/// its flow, are expanded in powers of h and compared. Cost: as many steps in series as there are letters,
/// some 2 ms for 23. The error of n steps of a processed word is that of P(-h) K^n P(h)^-1: it is the least
/// order of one step and of none.
///
/// Words with rotations obey the order conditions of those with drifts: all that these use of K is that it is
/// quadratic in p, and so is K with the quadratic part of V.
inline taylor_orders taylor_order(const word& letters, const std::vector<double>& coefficients) {
  std::string like = letters.letters();
  for (char& letter : like) {
    detail::with_letter(letter, known_letters{},
                        [&](auto flow) { letter = decltype(flow)::same_order_as::letter; });
  }
  const word split(like);
  const auto of_step = taylor_order_of(coefficients, [&](const order_probe& system, const auto& c) {
    auto x = system.start();
    stepper<order_probe>(system, split, c, 1.0).step(x);
    return x;
  });
  if (!split.is_processed()) return of_step;
  const auto of_none = detail::order_of_processor(split, coefficients);
  return {std::min(of_step.quadratic_kinetic, of_none.quadratic_kinetic),
          std::min(of_step.any_kinetic, of_none.any_kinetic)};
}

/// The orders of a method, at its own coefficients.
inline taylor_orders taylor_order(const tabulated& method) {
  return taylor_order(method.letters(), method.coefficients());
}

}  // namespace nysalt
