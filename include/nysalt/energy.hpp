// SPDX-License-Identifier: BSL-1.0
// K(p), its gradient, and H.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "nysalt/force.hpp"

namespace nysalt {

/// v = grad K(p): p_i / m_i, or the system's own, or by autodiff from its kinetic energy.
template <class T, System S>
void velocity(const S& system, const vector<T, S::dimension>& p, vector<T, S::dimension>& v) {
  if constexpr (HasVelocity<S, T>) {
    system.velocity(p, v);
  } else if constexpr (HasKineticEnergy<S, double>) {
    gradient<T, S::dimension>([&](const auto& y) { return system.kinetic_energy(y); }, p, 1.0, v);
  } else if constexpr (HasInverseMass<S>) {
    for (Eigen::Index i = 0; i < p.size(); ++i) v[i] = p[i] * system.inverse_mass(i);
  } else {
    for (Eigen::Index i = 0; i < p.size(); ++i) v[i] = p[i];
  }
}

/// K(p): the system's own, else sum_i p_i^2/(2 m_i).
template <class T, HasEnergy<T> S>
T kinetic_energy(const S& system, const vector<T, S::dimension>& p) {
  if constexpr (HasKineticEnergy<S, T>) {
    return system.kinetic_energy(p);
  } else {
    T sum(0.0);
    for (Eigen::Index i = 0; i < p.size(); ++i) {
      if constexpr (HasInverseMass<S>) {
        sum += p[i] * p[i] * system.inverse_mass(i);
      } else {
        sum += p[i] * p[i];
      }
    }
    return sum * 0.5;
  }
}

/// H(q, p) = K(p) + V(q).
template <class T, HasEnergy<T> S>
T energy(const S& system, const phase_point<T, S::dimension>& x) {
  return kinetic_energy<T>(system, x.p) + system.potential(x.q);
}

/// From the least to the largest H that was seen.
struct energy_range {
  double low = std::numeric_limits<double>::infinity();    ///< the least; above `high` before any
  double high = -std::numeric_limits<double>::infinity();  ///< the largest; below `low` before any

  /// Widens the range where it does not hold an energy.
  void include(double energy) {
    low = std::min(low, energy);
    high = std::max(high, energy);
  }

  /// The distance of an energy from the range; 0 inside, and within a millionth of the largest: where all
  /// trajectories have one energy, the energy of another differs by rounding and by the reference's error.
  double distance(double energy) const {
    if (!(low <= high)) return std::numeric_limits<double>::infinity();  // nothing was seen
    const double slack = 1e-6 * std::max(std::abs(low), std::abs(high));
    const double outside = std::max(low - energy, energy - high);
    return outside <= slack ? 0.0 : outside;
  }
  bool contains(double energy) const { return distance(energy) == 0.0; }  ///< or off by a millionth
};

}  // namespace nysalt
