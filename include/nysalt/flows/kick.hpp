// SPDX-License-Identifier: BSL-1.0
#pragma once

#include "nysalt/flow.hpp"

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
};

}  // namespace nysalt
