// SPDX-License-Identifier: BSL-1.0
// Extreme eigenvalues of the Hessian along the motion: stiffness and instability.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <ranges>
#include <stdexcept>
#include <vector>

#include "nysalt/derivatives/force_jacobian.hpp"
#include "nysalt/derivatives/lanczos.hpp"
#include "nysalt/detail/sentence.hpp"
#include "nysalt/force.hpp"

namespace nysalt {

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

}  // namespace nysalt
