// expect: nysalt: kinetic_energy is not of the form `template <class T> T kinetic_energy(p) const`
// SPDX-License-Identifier: BSL-1.0
#include "nysalt/method.hpp"
#include "nysalt/methods/classical.hpp"

struct misdeclared {
  static constexpr int dimension = 1;
  template <class T>
  T potential(const nysalt::vector<T, 1>& q) const {
    return q[0] * q[0];
  }
#ifdef NYSALT_CONTROL
  template <class T>
  T kinetic_energy(const nysalt::vector<T, 1>& p) const {
    return p[0] * p[0];
  }
#else
  // [mistake]
  template <class T>
  T kinetic_energy(const nysalt::vector<T, 1>& p) {
    return p[0] * p[0];
  }
  // [/mistake]
#endif
};

int main() {
  const misdeclared system;
  nysalt::make_stepper(system, nysalt::verlet(), 0.1);
}
