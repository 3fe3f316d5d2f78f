// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <cmath>
#include <string>

#include "nysalt/system.hpp"

namespace nysalt {

/// The Kepler problem in the plane, a unit mass drawn to the origin: H = (p_1^2 + p_2^2)/2 - 1/|q|
/// [hairer_lubich_wanner_2006, section I.2]. An ellipse of semi-major axis 1 has period 2 pi. Near the
/// centre the motion is as fast as |q|^{-3/2}: there is no highest frequency, and no bands are declared.
struct kepler {
  static constexpr int dimension = 2;

  template <class T>
  T potential(const vector<T, 2>& q) const {
    using std::sqrt;
    return T(-1.0) / sqrt(q[0] * q[0] + q[1] * q[1]);
  }
  template <class T>
  void force(const vector<T, 2>& q, vector<T, 2>& f) const {
    using std::sqrt;
    const T square = q[0] * q[0] + q[1] * q[1];
    const T pull = T(-1.0) / (square * sqrt(square));
    f[0] = q[0] * pull;
    f[1] = q[1] * pull;
  }

  std::string description() const { return "kepler()"; }
};

}  // namespace nysalt
