// SPDX-License-Identifier: BSL-1.0
// All frequencies of the linearised motion at a state, for any separable Hamiltonian.
#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <ranges>
#include <span>
#include <stdexcept>
#include <vector>

#include "nysalt/derivatives/force_jacobian.hpp"
#include "nysalt/derivatives/hessian_spectrum.hpp"
#include "nysalt/energy.hpp"
#include "nysalt/force.hpp"

namespace nysalt {

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
