// SPDX-License-Identifier: BSL-1.0
// The covariance that a linear step with noise keeps, and its error as a loss.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "nysalt/bath.hpp"
#include "nysalt/detail/sentence.hpp"
#include "nysalt/detail/served_letters.hpp"
#include "nysalt/losses/squares.hpp"
#include "nysalt/run_time_family.hpp"
#include "nysalt/scalar.hpp"
#include "nysalt/stepper.hpp"

namespace nysalt {

/// (x, y) <- (xx x + xy y, yx x + yy y); the identity by default.
template <Scalar T>
struct plane_map {
  T xx{1.0};  ///< matrix entry to x from x
  T xy{0.0};  ///< matrix entry to x from y
  T yx{0.0};  ///< matrix entry to y from x
  T yy{1.0};  ///< matrix entry to y from y

  T trace() const { return xx + yy; }                  ///< sum of the eigenvalues
  T determinant() const { return xx * yy - xy * yx; }  ///< product of the eigenvalues
};

/// First a, then b: the matrix b a.
template <Scalar T>
plane_map<T> compose(const plane_map<T>& a, const plane_map<T>& b) {
  return {b.xx * a.xx + b.xy * a.yx, b.xx * a.xy + b.xy * a.yy,  //
          b.yx * a.xx + b.yy * a.yx, b.yx * a.xy + b.yy * a.yy};
}

/// A symmetric matrix.
template <Scalar T>
struct plane_covariance {
  T xx{0.0};  ///< variance of x
  T xy{0.0};  ///< covariance of x and y
  T yy{0.0};  ///< variance of y

  /// Entry by entry.
  friend plane_covariance operator+(const plane_covariance& a, const plane_covariance& b) {
    return {a.xx + b.xx, a.xy + b.xy, a.yy + b.yy};
  }
  /// Every entry times c.
  friend plane_covariance operator*(const plane_covariance& a, const T& c) {
    return {a.xx * c, a.xy * c, a.yy * c};
  }
};

/// The covariance C after the map M: M C M^T.
template <Scalar T>
plane_covariance<T> congruence(const plane_map<T>& M, const plane_covariance<T>& C) {
  const T to_x_x = M.xx * C.xx + M.xy * C.xy;
  const T to_x_y = M.xx * C.xy + M.xy * C.yy;
  const T to_y_x = M.yx * C.xx + M.yy * C.xy;
  const T to_y_y = M.yx * C.xy + M.yy * C.yy;
  return {to_x_x * M.xx + to_x_y * M.xy, to_x_x * M.yx + to_x_y * M.yy, to_y_x * M.yx + to_y_y * M.yy};
}

/// S S^T - 1, which S adds to the covariance 1, if S has determinant 1. Its trace is written as squares,
/// which vanish to twice as many digits where S is a rotation: weak friction magnifies an error of the trace
/// by 1/(gamma h), and of the rest by no more than 1/(1 - |trace S|/2).
template <Scalar T>
plane_covariance<T> excess_of_turn(const plane_map<T>& S) {
  const T diagonal = S.xx - S.yy;
  const T shear = S.xy + S.yx;
  const T sum = diagonal * diagonal + shear * shear;
  const T difference = (S.xx * S.xx - S.yy * S.yy) + (S.xy * S.xy - S.yx * S.yx);
  return {(sum + difference) * 0.5, S.xx * S.yx + S.xy * S.yy, (sum - difference) * 0.5};
}

/// Whether both eigenvalues lie inside the unit circle (Schur, Cohn and Jury).
template <Scalar T>
bool is_schur_stable(const plane_map<T>& M) {
  const T d = M.determinant();
  const T t = M.trace();
  return d < T(1.0) && d > T(-1.0) && t < d + 1.0 && -t < d + 1.0;
}

/// Infinite: the value where there is no such covariance.
template <Scalar T>
plane_covariance<T> no_covariance() {
  const T infinity(std::numeric_limits<double>::infinity());
  return {infinity, infinity, infinity};
}

/// The D with D = M D M^T + R; infinite unless M is Schur stable. With L the map D -> M D M^T, whose
/// eigenvalues are d, the determinant of M, and the squares of its two, Cayley-Hamilton says L^3 - e L^2 + d
/// e L - d^3 = 0 with e = t^2 - d, t the trace. Dividing by L - 1 gives
///   D = (L^2 + (1 - e) L + 1 - e + d e) R / ((1 - d) (1 + d - t) (1 + d + t)).
/// Rounding errs by some eps |R| over that denominator.
template <Scalar T>
plane_covariance<T> discrete_lyapunov(const plane_map<T>& M, const plane_covariance<T>& R) {
  if (!is_schur_stable(M)) return no_covariance<T>();
  const T d = M.determinant();
  const T t = M.trace();
  const T e = t * t - d;
  const T denominator = (1.0 - d) * (d + 1.0 - t) * (d + 1.0 + t);
  const auto once = congruence(M, R);
  const auto twice = congruence(M, once);
  return (twice + once * (1.0 - e) + R * (1.0 - e + d * e)) * (1.0 / denominator);
}

// The distance of the stationary distribution of a thermostatted word from the Gibbs distribution, mode by
// mode.

namespace detail {
/// A mode of unit mass by itself, all of which is quadratic.
struct single_mode {
  static constexpr int dimension = 1;
  double omega;
  template <class T>
  void force(const vector<T, 1>& q, vector<T, 1>& f) const {
    f[0] = q[0] * (-omega * omega);
  }
  template <class T>
  void soft_force(const vector<T, 1>&, vector<T, 1>& f) const {
    f[0] = T(0.0);
  }
  normal_modes modes() const {
    return {Eigen::MatrixXd::Identity(1, 1), Eigen::VectorXd::Constant(1, omega)};
  }
};
}  // namespace detail

/// On a mode of frequency omega > 0, x = omega q/sqrt(kT) and y = p/sqrt(kT) have the covariance 1 in the
/// Gibbs distribution. A word steps them by (x, y) <- M (x, y) + normal noise, and the distribution after a
/// step has the covariance 1 + D that solves a discrete Lyapunov equation. The loss is the sum of D_xx^2 + 2
/// D_xy^2 + D_yy^2 over the modes: each gives the residuals D_xx, sqrt(2) D_xy and D_yy. They have no units,
/// and depend on h omega and gamma h only.
///
/// Why these weights: but for third powers of D the loss is four times the Kullback-Leibler divergence of the
/// word's distribution from the Gibbs distribution, and that adds up over modes. So a frequency that r modes
/// share counts r times, and by Pinsker's inequality no observable of the modes errs by more than
/// sqrt(loss/8) in total variation. Positions count as much as momenta, as they do in energies; for the
/// distribution of positions only BAOAB is exact at one evaluation. Where D vanishes no weight matters: for
/// O/2 S O/2 and S O it does where S turns the circle x^2 + y^2 = 1, as O keeps it.
///
/// Modes of frequency zero are left out, as they have no stationary distribution of their own, and so is all
/// that is not quadratic.
class stationary_covariance {
 public:
  /// Loss of a word with letters O. Throws std::invalid_argument if it has none, or a letter that the system
  /// does not serve; if the bath has no friction or no temperature; if no frequency is above zero; or if the
  /// step is not positive and finite.
  template <System S>
    requires(HasBath<S> && HasModes<S>)
  stationary_covariance(const S& system, const run_time_word& word, double step)
      : word_(word), step_(step), bath_(system.bath()) {
    require_law();
    const normal_modes modes = system.modes();
    for (const double omega : modes.frequencies) {
      if (omega > 0.0) ++multiplicity_of_[omega];
    }
    if (multiplicity_of_.empty()) {
      throw std::invalid_argument(sentence(
          "covariance loss: {} must have a mode of a frequency above 0, got none", describe(system)));
    }
    require_served<S, double>(word, system);
    split_at_bath();
  }

  /// Three for each distinct frequency, from the lowest up, times the root of its multiplicity.
  /// Infinite where the word has no stationary distribution: its spectral radius is not below 1, or a letter
  /// O goes back in time. T is double or a dual of it. Cost: each letter twice for each frequency, on one
  /// number. Throws std::invalid_argument unless there is a coefficient for each slot.
  template <Scalar T>
  std::vector<T> residuals(const std::vector<T>& coefficients) const {
    word_.require_one_for_each_slot(coefficients);
    std::vector<T> result;
    for (const auto& [omega, multiplicity] : multiplicity_of_) {
      const double weight = std::sqrt(static_cast<double>(multiplicity));
      const auto D = excess(omega, coefficients);
      result.push_back(D.xx * weight);
      result.push_back(D.xy * (weight * std::numbers::sqrt2));
      result.push_back(D.yy * weight);
    }
    return result;
  }

  /// The loss and its derivatives by theta, from the coefficients at theta and their Jacobian: a row for
  /// each coefficient, a column for each parameter.
  squares at(const std::vector<double>& coefficients, const Eigen::MatrixXd& jacobian) const;

 private:
  /// A letter O, or all letters between two letters O.
  struct piece {
    std::size_t first;  // of its slots
    std::optional<run_time_word> turn;
  };

  void require_law() const;
  void split_at_bath();

  /// The map M of the word and the excess R of the covariance 1: then D = M D M^T + R.
  template <Scalar T>
  plane_covariance<T> excess(double omega, const std::vector<T>& c) const {
    plane_map<T> M;
    plane_covariance<T> R;
    for (const auto& [first, turn] : pieces_) {
      if (turn) {
        const auto S = map_of(*turn, &c[first], omega);
        R = congruence(S, R) + excess_of_turn(S);
        M = compose(M, S);
      } else {  // O keeps the covariance 1: it makes no excess of its own
        if (c[first] < T(0.0)) return no_covariance<T>();
        plane_map<T> damping;
        damping.yy = bath_.decay(c[first] * step_);
        R = congruence(damping, R);
        M = compose(M, damping);
      }
    }
    return discrete_lyapunov(M, R);
  }

  /// The map of (x, y) by letters without O, as the stepper computes the map.
  template <Scalar T>
  plane_map<T> map_of(const run_time_word& turn, const T* c, double omega) const {
    const detail::single_mode mode{omega};
    const stepper<detail::single_mode, T> one(mode, turn, {c, c + turn.slots}, step_);
    phase_point<T, 1> from_x{vector<T, 1>(T(1.0 / omega)), vector<T, 1>(T(0.0))};
    phase_point<T, 1> from_y{vector<T, 1>(T(0.0)), vector<T, 1>(T(1.0))};
    one.step(from_x);
    one.step(from_y);
    return {from_x.q[0] * omega, from_y.q[0] * omega, from_x.p[0], from_y.p[0]};
  }

  run_time_word word_;
  double step_;
  bath bath_;
  std::map<double, int> multiplicity_of_;  // of each frequency
  std::vector<piece> pieces_;
};

/// The loss as a function of theta only, for a family with the letters of the loss.
objective objective_of(const stationary_covariance& loss, const run_time_family& family);

}  // namespace nysalt
