// expect: nysalt: the letter D needs a quadratic kinetic energy
// SPDX-License-Identifier: BSL-1.0
#include <cmath>

#include "nysalt/families/fd_chin.hpp"
#include "nysalt/stepper.hpp"

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
  const relativistic system;
  const auto coefficients = nysalt::fd_chin::coefficients(nysalt::fd_chin::start());
  // [mistake]
  nysalt::stepper<relativistic, nysalt::fd_chin::word>(system, coefficients, 0.1);
  // [/mistake]
}
