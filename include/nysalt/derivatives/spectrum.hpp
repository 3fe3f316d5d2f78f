// SPDX-License-Identifier: BSL-1.0
// Derivatives of the force and their eigenvalues: frequencies at a state.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <random>
#include <ranges>
#include <span>
#include <stdexcept>
#include <type_traits>
#include <vector>

#include "nysalt/detail/sentence.hpp"
#include "nysalt/energy.hpp"
#include "nysalt/force.hpp"

// Derivatives of what cannot be differentiated otherwise.

namespace nysalt::detail {

/// Adapted differences err by 1e-7 of what they differentiate for one that is some r = |V|/(L |f|) = 1 of it,
/// and by r times their rounding, 1e-11: below this for r < 10^7.
inline double tolerance_of_differences() { return 30.0 * std::cbrt(std::numeric_limits<double>::epsilon()); }

/// The derivative of function(vector), a double or a vector, along a direction whose size is that of a
/// displacement of the motion.
auto difference_along(const auto& function, const Eigen::VectorXd& x, const Eigen::VectorXd& direction) {
  using result_type = std::decay_t<decltype(function(x))>;
  const double farthest = farthest_from(x, direction);
  if constexpr (std::is_same_v<result_type, double>) {
    using number = Eigen::Matrix<double, 1, 1>;
    const auto value_at = [&](double s, number& y) { y[0] = function(Eigen::VectorXd(x + s * direction)); };
    const number middle(function(x));
    number result(0.0);
    adapted_difference(value_at, middle, number(1.0), noise_of_forces * std::abs(middle[0]), farthest,
                       result);
    return result[0];
  } else {
    const auto value_at = [&](double s, Eigen::VectorXd& y) {
      y = function(Eigen::VectorXd(x + s * direction));
    };
    const Eigen::VectorXd middle = function(x);
    const double noise = noise_of_forces * direction.cwiseAbs().dot(middle.cwiseAbs());
    Eigen::VectorXd result = x;
    adapted_difference(value_at, middle, direction, noise, farthest, result);
    return result;
  }
}

/// The length of each coordinate, from where points are: the distance between the lowest and the highest. Of
/// a coordinate that does not move that of the one that moves farthest; if none does how far all are from the
/// origin, and 1 if they are there.
inline Eigen::VectorXd lengths_of(const std::vector<Eigen::VectorXd>& points) {
  Eigen::VectorXd low = points.front();
  Eigen::VectorXd high = points.front();
  for (const auto& x : points) {
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  const Eigen::VectorXd size = low.cwiseAbs().cwiseMax(high.cwiseAbs());
  constexpr double rounding = 1e-9;  // of where a coordinate is: less cannot be divided into steps
  Eigen::VectorXd result = high - low;
  for (Eigen::Index i = 0; i < result.size(); ++i) {
    if (!(result[i] > rounding * size[i])) result[i] = 0.0;
  }
  double instead = result.maxCoeff();
  if (!(instead > 0.0)) instead = size.maxCoeff();
  if (!(instead > 0.0) || !std::isfinite(instead)) instead = 1.0;
  for (double& length : result) {
    if (!(length > 0.0) || !std::isfinite(length)) length = instead;
  }
  return result;
}

}  // namespace nysalt::detail

// Products with f'(q) at one state after the other, of any force.

namespace nysalt {

/// f'(q) v of a field at states of a motion. Differences of a black box go a part of how far the states lie
/// apart. Refers to the system.
template <field F, System S>
  requires ForceDerivativeOver<S, double, F>
class force_jacobian {
 public:
  /// The Jacobian of the force on the motion that passes through these states (a range of phase_point<double,
  /// N>).
  force_jacobian(const S& system, const std::ranges::range auto& states)
      : system_(&system),
        room_(size(system)),
        q_(vector<double, S::dimension>::Zero(size(system))),
        v_(q_),
        f_(q_),
        g_(q_) {
    if (differs()) {
      std::vector<Eigen::VectorXd> points;
      for (const auto& state : states) points.push_back(state.q);
      if (!points.empty()) lengths_ = detail::lengths_of(points);
    }
  }

  /// Moves to the state where the next products are taken. Cost: a force, of a black box.
  void move_to(const vector<double, S::dimension>& q) {
    q_ = q;
    if constexpr (may_differ) {
      if (differs()) system_->force(q_, f_);
    }
  }

  /// f'(q) v. Cost: one directional derivative.
  const vector<double, S::dimension>& times(const vector<double, S::dimension>& v) {
    if constexpr (may_differ) {
      if (differs()) {
        const double displacements = v.cwiseQuotient(lengths_).cwiseAbs().maxCoeff();
        v_ = v / displacements;
        directional_derivative(*system_, q_, v_, f_, g_);
        g_ *= displacements;
        return g_;
      }
    }
    force_along<F, double>(*system_, q_, v, g_, room_);
    return g_;
  }

 private:
  static constexpr bool may_differ = F == field::whole && (ErasedSystem<S> || derivative_calls<S> == 2);
  bool differs() const { return may_differ && calls_of_derivative(*system_) == 2; }

  const S* system_;
  lifted_room<double, S::dimension> room_;
  vector<double, S::dimension> q_;
  vector<double, S::dimension> v_;
  vector<double, S::dimension> f_;
  vector<double, S::dimension> g_;
  Eigen::VectorXd lengths_;
};

// Both ends of a symmetric spectrum, from products with vectors only.

/// Both ends of a spectrum, with approximate eigenvectors.
struct spectrum_ends {
  double lowest;                      ///< a bound from below of the lowest eigenvalue found
  double highest;                     ///< a bound from above of the highest eigenvalue found
  Eigen::VectorXd lowest_direction;   ///< the Ritz vector of the lowest, of length 1
  Eigen::VectorXd highest_direction;  ///< the Ritz vector of the highest, of length 1
  int products;                       ///< applications of the map
};

/// A symmetric map v -> A v.
using symmetric_map = std::function<Eigen::VectorXd(const Eigen::VectorXd&)>;

/// The ends of the spectrum of A, from a start with a part in every direction [lanczos_1950]. Each
/// end is a Ritz value moved outwards by its residual, so that it bounds the eigenvalue that it belongs to;
/// of many close ones that may be another than the last, less than the error away. It stops when the
/// residuals are below relative_error of the highest end (or of 1 % of the lowest, if that is larger in size)
/// and of the larger of both; after 100 products they are what they are. Unlike power iteration it needs no
/// shift where negative ends are larger in size than positive ones. Both ends are NaN if a product is not
/// finite. Cost: some 8 to 40 products, and k^2 dot products for k.
spectrum_ends ends_of_spectrum(const symmetric_map& multiply, const Eigen::VectorXd& start,
                               double relative_error = 0.01);

// Extreme eigenvalues of the Hessian along the motion: stiffness and instability.

/// Eigenvalues of -M^{-1/2} f'(q) M^{-1/2} over some states: squares of frequencies, or, where negative, of
/// rates at which neighbours part.
struct stiffness_range {
  double lowest = std::numeric_limits<double>::infinity();  ///< least eigenvalue of all states
  /// Largest eigenvalue of all states.
  double highest = -std::numeric_limits<double>::infinity();
  std::vector<double> highest_of_state;  ///< largest eigenvalue of each state
  std::int64_t states = 0;               ///< number of states examined
  std::int64_t evaluations = 0;          ///< evaluations of f'(q) v

  /// sqrt(highest), 0 if that is negative.
  double highest_frequency() const { return std::sqrt(std::max(0.0, highest)); }
};

/// Range of the Hessian's spectrum over all states (a range of phase_point<double, N>), of the whole force or
/// of its soft part. Both ends are known to 1 % and mostly rounded outwards, see ends_of_spectrum(); who
/// needs a bound adds a percent. The same states give the same bits. Differences of a black box go a part of
/// how far the states lie apart. Cost: some 8 to 40 directional derivatives a state, less below 8 dimensions.
/// Throws std::invalid_argument if there are no states, or one where the force has no finite derivative.
template <field F = field::whole, NystromSystem S>
  requires ForceDerivativeOver<S, double, F>
stiffness_range hessian_spectrum(const S& system, const std::ranges::range auto& states) {
  const Eigen::Index n = size(system);
  Eigen::VectorXd root = Eigen::VectorXd::Ones(n);  // M^{-1/2}
  if constexpr (HasInverseMass<S>) {
    for (Eigen::Index i = 0; i < n; ++i) root[i] = std::sqrt(system.inverse_mass(i));
  }
  // Every start has a part of chance, the same for all, so that no end can hide from it; and of the ends of
  // the state before, which are near.
  std::mt19937_64 bits{1};
  Eigen::VectorXd chance(n);
  for (double& x : chance) x = static_cast<double>(bits() >> 11U) * 0x1p-53 - 0.5;
  chance.normalize();
  Eigen::VectorXd start = chance;

  stiffness_range found;
  force_jacobian<F, S> jacobian(system, states);
  auto v = make_vector<double>(system);
  for (const auto& state : states) {
    jacobian.move_to(state.q);
    const auto multiply = [&](const Eigen::VectorXd& x) -> Eigen::VectorXd {
      v = root.cwiseProduct(x);
      return -root.cwiseProduct(jacobian.times(v));
    };
    const auto ends = ends_of_spectrum(multiply, start);
    if (!std::isfinite(ends.lowest) || !std::isfinite(ends.highest)) {
      throw std::invalid_argument(
          sentence("hessian_spectrum: the force must have a finite derivative at each state, got none "
                   "at state {}; leave that state out",
                   found.states));
    }
    found.lowest = std::min(found.lowest, ends.lowest);
    found.highest = std::max(found.highest, ends.highest);
    found.highest_of_state.push_back(ends.highest);
    found.evaluations += ends.products;
    ++found.states;
    start = chance + ends.lowest_direction + ends.highest_direction;
  }
  if (found.states == 0)
    throw std::invalid_argument("hessian_spectrum: states must hold one or more, got none");
  return found;
}

// All frequencies of the linearised motion at a state, for any separable Hamiltonian.

namespace detail {
/// grad K can be differentiated.
template <class S>
concept HasDifferentiableVelocity =
    NystromSystem<S> || HasVelocity<S, dual<double, 1>> ||
    (HasKineticEnergy<S, double> && HasKineticEnergy<S, dual<dual<double, 1>, sweep<S::dimension>>>);

/// Whether it can.
template <System S>
bool has_differentiable_velocity(const S& system) {
  if constexpr (ErasedSystem<S>) return system.facts().has_differentiable_velocity;
  return HasDifferentiableVelocity<S>;
}

/// V''(q), or that of the soft part, where the Jacobian of the force is taken.
template <field F, System S>
Eigen::MatrixXd potential_hessian(force_jacobian<F, S>& jacobian, const vector<double, S::dimension>& q) {
  const Eigen::Index n = q.size();
  jacobian.move_to(q);
  vector<double, S::dimension> v = q;
  Eigen::MatrixXd hessian(n, n);
  for (Eigen::Index j = 0; j < n; ++j) {
    for (Eigen::Index i = 0; i < n; ++i) v[i] = i == j ? 1.0 : 0.0;
    hessian.col(j) = -jacobian.times(v);
  }
  return 0.5 * (hessian + hessian.transpose());
}

/// A factor L of the symmetric A = L L^T; empty where A is not positive semidefinite.
Eigen::MatrixXd factor_of(const Eigen::MatrixXd& A);
/// Square roots of the eigenvalues of a symmetric matrix, from low to high; 0 where negative.
std::vector<double> frequencies_of(const Eigen::MatrixXd& stiffness);

inline Eigen::MatrixXd factor_of_kinetic(const Eigen::MatrixXd& hessian) {
  if (!hessian.allFinite()) return {};
  return factor_of(0.5 * (hessian + hessian.transpose()));
}

/// A factor L of K''(p) = L L^T; empty where K''(p) is not positive semidefinite.
template <System S>
Eigen::MatrixXd kinetic_factor(const S& system, const vector<double, S::dimension>& p) {
  const Eigen::Index n = size(system);
  if constexpr (ErasedSystem<S>) {
    if (!has_quadratic_kinetic(system)) return factor_of_kinetic(system.kinetic_hessian(p));
  }
  if constexpr (NystromSystem<S>) {
    Eigen::VectorXd root = Eigen::VectorXd::Ones(n);
    if constexpr (HasInverseMass<S>) {
      for (Eigen::Index i = 0; i < n; ++i) root[i] = std::sqrt(system.inverse_mass(i));
    }
    return root.asDiagonal();
  } else {
    using D = dual<double, 1>;
    vector<D, S::dimension> lifted(n);
    vector<D, S::dimension> v(n);
    Eigen::MatrixXd hessian(n, n);
    for (Eigen::Index i = 0; i < n; ++i) lifted[i] = D(p[i]);
    for (Eigen::Index j = 0; j < n; ++j) {
      lifted[j] = D::variable(p[j], 0);
      velocity<D>(system, lifted, v);
      lifted[j] = D(p[j]);
      for (Eigen::Index i = 0; i < n; ++i) hessian(i, j) = v[i].derivative[0];
    }
    return factor_of_kinetic(hessian);
  }
}
}  // namespace detail

/// Frequencies of the linearised motion at (q, p), from low to high: square roots of the eigenvalues of
/// K''(p) V''(q), 0 where negative. Empty where K''(p) is not positive semidefinite. Throws
/// std::invalid_argument if a derivative is not finite. Cost: as many directional derivatives as there are
/// degrees of freedom, and the eigenvalues of a matrix of that size.
template <SeparableSystem S>
  requires detail::HasDifferentiableVelocity<S>
std::vector<double> frequencies_at(const S& system, force_jacobian<field::whole, S>& jacobian,
                                   const phase_point<double, S::dimension>& state) {
  const Eigen::MatrixXd factor = detail::kinetic_factor(system, state.p);
  if (factor.size() == 0) return {};
  const Eigen::MatrixXd stiffness =
      factor.transpose() * detail::potential_hessian(jacobian, state.q) * factor;
  if (!stiffness.allFinite()) {
    throw std::invalid_argument(
        "frequencies_at: the force must have a finite derivative at the state, got none");
  }
  return detail::frequencies_of(stiffness);
}

/// Frequencies at a single state.
template <SeparableSystem S>
  requires detail::HasDifferentiableVelocity<S>
std::vector<double> frequencies_at(const S& system, const phase_point<double, S::dimension>& state) {
  force_jacobian<field::whole, S> jacobian(system, std::span(&state, 1));
  return frequencies_at(system, jacobian, state);
}

/// Frequencies along some states.
struct frequencies_along {
  std::vector<std::vector<double>> of_state;  ///< frequencies of each state, from low to high
  bool are_complete = false;                  ///< false: of each state only the highest, or none at all

  /// A frequency and the state where it occurs.
  struct maximum {
    double frequency = 0.0;  ///< frequency of the linearised motion
    std::size_t state = 0;   ///< number of the state
  };
  /// The highest frequency and the state where it occurs; 0 and 0 if none is known.
  maximum highest() const {
    maximum result;
    for (std::size_t k = 0; k < of_state.size(); ++k) {
      if (of_state[k].empty() || of_state[k].back() <= result.frequency) continue;
      result = {of_state[k].back(), k};
    }
    return result;
  }
};

/// Above this number of degrees of freedom only the highest frequency of a state is computed.
inline constexpr Eigen::Index most_for_all_frequencies = 64;

/// All frequencies of each state (a range of phase_point<double, N>) of a system of at most
/// most_for_all_frequencies degrees of freedom; of a larger one with a quadratic kinetic energy the highest,
/// known to 1 %; else none. Throws what frequencies_at() and hessian_spectrum() do. Cost: of each state that
/// of frequencies_at(), or 8 to 40 directional derivatives.
template <SeparableSystem S>
frequencies_along frequencies_of_states(const S& system, const std::ranges::range auto& states) {
  frequencies_along result;
  if constexpr (detail::HasDifferentiableVelocity<S> && ForceDerivativeOver<S, double, field::whole>) {
    if (size(system) <= most_for_all_frequencies && detail::has_differentiable_velocity(system)) {
      result.are_complete = true;
      force_jacobian<field::whole, S> jacobian(system, states);
      for (const auto& state : states) result.of_state.push_back(frequencies_at(system, jacobian, state));
      return result;
    }
  }
  if constexpr (NystromSystem<S>) {
    if (std::ranges::empty(states) || !has_quadratic_kinetic(system)) return result;
    for (const double square : hessian_spectrum(system, states).highest_of_state) {
      result.of_state.push_back({std::sqrt(std::max(0.0, square))});
    }
  }
  return result;
}

}  // namespace nysalt
