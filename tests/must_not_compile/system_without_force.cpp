// expect: nysalt: a separable system offers `template <class T> T potential(q)`, or `force(q, f)` as a
//   template or over double, const all of them; see nysalt/system.hpp
// SPDX-License-Identifier: BSL-1.0
#include "nysalt/method.hpp"
#include "nysalt/methods/classical.hpp"

struct incomplete {
  static constexpr int dimension = 1;
#ifdef NYSALT_CONTROL
  template <class T>
  T potential(const nysalt::vector<T, 1>& q) const {
    return q[0] * q[0];
  }
#endif
};

int main() {
  const incomplete system;
  nysalt::make_stepper(system, nysalt::verlet(), 0.1);
}
