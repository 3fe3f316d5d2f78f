// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <algorithm>

#include "nysalt/derivatives/jacobian.hpp"

namespace nysalt {

/// Largest coordinate of R Phi R Phi(x) - x with R(q, p) = (q, -p): zero to rounding for reversible maps
/// [hairer_lubich_wanner_2006, definition V.1.2].
template <int N>
double reversibility_defect(const auto& map, const phase_point<double, N>& x) {
  auto y = x;
  for (int half = 0; half < 2; ++half) {
    map(y);
    y.p = (-y.p).eval();
  }
  return std::max((y.q - x.q).cwiseAbs().maxCoeff(), (y.p - x.p).cwiseAbs().maxCoeff());
}

/// Reversibility defect of one step of a method.
template <System S, Method M>
double reversibility_defect(const S& system, const M& method, double step,
                            const phase_point<double, S::dimension>& x) {
  return reversibility_defect(step_map(system, method, step), x);
}

}  // namespace nysalt
