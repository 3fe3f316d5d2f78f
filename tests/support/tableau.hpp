// SPDX-License-Identifier: BSL-1.0
// The two-stage Nystrom method as its inventors write it, an oracle that shares no code with the library.
#pragma once

#include "nysalt/system.hpp"

namespace nysalt::test {

/// The tableau of an explicit two-stage Nystrom method for unit masses
/// [li_lu_tao_ye_2023, equation (2.5)].
struct tableau {
  double c1, c2, a21, beta1, beta2, b1, b2;

  /// The symplectic ones [li_lu_tao_ye_2023, equation (2.11)].
  static tableau symplectic(double b1, double beta1) {
    tableau t{};
    t.b1 = b1;
    t.b2 = 1.0 - b1;
    t.beta1 = beta1;
    t.beta2 = 0.5 - beta1;
    t.c1 = 1.0 - t.beta1 / t.b1;
    t.c2 = 1.0 - t.beta2 / t.b2;
    t.a21 = t.b1 * (t.c2 - t.c1);
    return t;
  }

  template <System S, Scalar T>
  void step(const S& system, phase_point<T, S::dimension>& x, double h) const {
    auto stage = x.q;
    auto l1 = x.q;
    auto l2 = x.q;
    for (Eigen::Index i = 0; i < x.size(); ++i) stage[i] = x.q[i] + x.p[i] * (c1 * h);
    force<T>(system, stage, l1);
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      stage[i] = x.q[i] + x.p[i] * (c2 * h) + l1[i] * (a21 * h * h);
    }
    force<T>(system, stage, l2);
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      x.q[i] += x.p[i] * h + (l1[i] * beta1 + l2[i] * beta2) * (h * h);
      x.p[i] += (l1[i] * b1 + l2[i] * b2) * h;
    }
  }
};

}  // namespace nysalt::test
