// expect GNU: required for the satisfaction of 'NystromSystem<S>' [with S = relativistic]
// expect Clang: because 'relativistic' does not satisfy 'NystromSystem'
// SPDX-License-Identifier: BSL-1.0
#include <cmath>

#include "nysalt/systems/in_bath.hpp"

struct relativistic {
  static constexpr int dimension = 1;
  template <class T>
  T potential(const nysalt::vector<T, 1>& q) const {
    return q[0] * q[0];
  }
#ifndef NYSALT_CONTROL
  template <class T>
  T kinetic_energy(const nysalt::vector<T, 1>& p) const {
    using std::sqrt;
    return sqrt(p[0] * p[0] + 1.0);
  }
#endif
};

int main() {
  // [mistake]
  const nysalt::in_bath<relativistic> system({}, nysalt::bath::of_sigma(0.1, 0.2));
  // [/mistake]
  return system.bath().acts() ? 0 : 1;
}
