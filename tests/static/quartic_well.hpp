// SPDX-License-Identifier: BSL-1.0
// The least system, which other minimal models are tried on: what docs/concepts shows.
#pragma once

#include "nysalt/phase_point.hpp"
#include "nysalt/system.hpp"

namespace nysalt::test {

// [system]
struct quartic_well {
  static constexpr int dimension = 1;

  template <class T>
  T potential(const nysalt::vector<T, 1>& q) const {
    const T square = q[0] * q[0];
    return square * square * 0.25;
  }
};
static_assert(nysalt::NystromSystem<quartic_well>);
// [/system]

/// A state of one coordinate.
inline phase_point<double, 1> at(double q, double p) { return {vector<double, 1>(q), vector<double, 1>(p)}; }

}  // namespace nysalt::test
