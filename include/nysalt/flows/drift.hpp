// SPDX-License-Identifier: BSL-1.0
#pragma once

#include "nysalt/energy.hpp"
#include "nysalt/flow.hpp"

namespace nysalt {

/// A: the flow of K(p), q += c h grad K(p); with masses q_i += c h p_i / m_i.
struct drift {
  static constexpr char letter = 'A';
  static constexpr std::size_t slots = 1;
  static constexpr field reads = field::none;
  static constexpr int force_derivatives = 0;
  static constexpr bool moves_q = true;
  static constexpr bool additive = true;
  static constexpr splitting splits = splitting::kinetic_and_potential;
  static constexpr bool invertible = true;
  using same_order_as = drift;

  template <System S, Scalar T>
  static constexpr bool serves = true;

  template <Scalar C>
  static C prepare(const C& c, double h) {
    return c * h;
  }

  template <System S, class State, CoefficientOf<typename State::scalar_type> C>
  static void apply(const S& system, const C& c, State& x, auto&) {
    using T = typename State::scalar_type;
    const Eigen::Index n = size(system);
    if constexpr (ErasedSystem<S>) {
      if (!system.has_unit_mass() || !has_quadratic_kinetic(system)) {
        return system.template kernels<T>().drift(x.q, x.p, c);
      }
      for (Eigen::Index i = 0; i < n; ++i) x.q[i] += x.p[i] * c;
    } else if constexpr (HasVelocity<S, double> || HasKineticEnergy<S, double>) {
      auto v = make_vector<T>(system);
      velocity<T>(system, x.p, v);
      for (Eigen::Index i = 0; i < n; ++i) x.q[i] += v[i] * c;
    } else if constexpr (HasInverseMass<S>) {
      for (Eigen::Index i = 0; i < n; ++i) x.q[i] += x.p[i] * (c * system.inverse_mass(i));
    } else {
      for (Eigen::Index i = 0; i < n; ++i) x.q[i] += x.p[i] * c;
    }
  }

  template <class P>
  static void on_oscillator(const auto&, const double* c, P& q, const P& p) {
    q += c[0] * p;
  }
};

}  // namespace nysalt
