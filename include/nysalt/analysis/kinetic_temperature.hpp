// SPDX-License-Identifier: BSL-1.0
// The temperature that the momenta show.
#pragma once

#include "nysalt/energy.hpp"

namespace nysalt {

/// sum_i p_i dK/dp_i / N, which is sum_i p_i^2/m_i / N for K = p M^-1 p / 2: its mean in the Gibbs ensemble
/// is kT, by equipartition. In units of energy. T is double or a pack.
template <class T, SystemOver<T> S>
T kinetic_temperature(const S& system, const phase_point<T, S::dimension>& x) {
  auto v = make_vector<T>(system);
  velocity<T>(system, x.p, v);
  T sum(0.0);
  for (Eigen::Index i = 0; i < x.size(); ++i) sum += x.p[i] * v[i];
  return sum / static_cast<double>(x.size());
}

/// Kinetic temperature of the momenta p + (h/2) force(q) between two steps. For words that begin and end with
/// half a kick (Verlet, BAOAB) its mean is kT on a harmonic oscillator, where that of the momenta at the
/// steps is low by z^2/4, z = omega h; of words that begin with a drift it knows nothing. Cost: one force.
template <class T, SystemOver<T> S>
T half_step_kinetic_temperature(const S& system, double step, const phase_point<T, S::dimension>& x) {
  auto f = make_vector<T>(system);
  force<T>(system, x.q, f);
  phase_point<T, S::dimension> between = x;
  for (Eigen::Index i = 0; i < x.size(); ++i) between.p[i] += f[i] * (0.5 * step);
  return kinetic_temperature<T>(system, between);
}

}  // namespace nysalt
