// expect: nysalt: the order of this method needs a quadratic kinetic energy, but the system has a kinetic
//   energy of its own
// SPDX-License-Identifier: BSL-1.0
#include <cmath>

#include "nysalt/method.hpp"
#include "nysalt/methods/classical.hpp"

struct relativistic {
  static constexpr int dimension = 1;
  template <class T>
  T potential(const nysalt::vector<T, 1>& q) const {
    return q[0] * q[0];
  }
#ifndef NYSALT_CONTROL
  // [mistake]
  template <class T>
  T kinetic_energy(const nysalt::vector<T, 1>& p) const {
    using std::sqrt;
    return sqrt(p[0] * p[0] + 1.0);
  }
  // [/mistake]
#endif
};

int main() {
  const relativistic system;
  nysalt::make_stepper(system, nysalt::srkn11b(), 0.1);
}
