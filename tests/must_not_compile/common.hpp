// SPDX-License-Identifier: BSL-1.0
// What several cases use.
#pragma once

#include <cmath>

#include "nysalt/system.hpp"

#ifdef NYSALT_CONTROL
template <class Right, class Wrong>
using either = Right;
#else
template <class Right, class Wrong>
using either = Wrong;
#endif

/// V = q^2.
struct well {
  static constexpr int dimension = 1;
  template <class T>
  T potential(const nysalt::vector<T, 1>& q) const {
    return q[0] * q[0];
  }
};

/// K = sqrt(p^2 + 1); in the control p^2/2.
struct relativistic : well {
#ifndef NYSALT_CONTROL
  // [relativistic]
  template <class T>
  T kinetic_energy(const nysalt::vector<T, 1>& p) const {
    using std::sqrt;
    return sqrt(p[0] * p[0] + 1.0);
  }
  // [/relativistic]
#endif
};
