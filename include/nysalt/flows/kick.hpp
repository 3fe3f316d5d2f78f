// SPDX-License-Identifier: BSL-1.0
#pragma once

#include "nysalt/flow.hpp"
#include "nysalt/force.hpp"

namespace nysalt {

/// B: the flow of V(q), p += c h force(q).
struct kick {
  static constexpr char letter = 'B';
  static constexpr bool reads_force = true;
  static constexpr bool moves_q = false;
  static constexpr bool additive = true;

  template <Scalar C>
  static C prepare(const C& c, double h) {
    return c * h;
  }

  template <System S, Scalar T, CoefficientOf<T> C>
  static void apply(const S& system, const C& c, flow_state<T, S::dimension>& x) {
    const Eigen::Index n = size(system);
    for (Eigen::Index i = 0; i < n; ++i) x.p[i] += x.f[i] * c;
  }

  /// By the system's own kick, or with a force that is at home in registers if its dimension is fixed.
  template <System S, Scalar T, CoefficientOf<T> C>
  static void evaluate_and_apply(const S& system, const C& c, flow_state<T, S::dimension>& x) {
    if constexpr (HasKick<S, T, C>) {
      system.kick(x.q, x.p, c);
    } else if constexpr (S::dimension != Eigen::Dynamic) {
      vector<T, S::dimension> f;
      force<T>(system, x.q, f);
      for (Eigen::Index i = 0; i < S::dimension; ++i) x.p[i] += f[i] * c;
    } else {
      force<T>(system, x.q, x.f);
      apply(system, c, x);
    }
  }
};

}  // namespace nysalt
