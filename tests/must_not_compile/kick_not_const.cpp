// expect: nysalt: kick is not of the form `template <class T, class C> void kick(q, p, c) const`
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
  template <class T, class C>
  void kick(const nysalt::vector<T, 1>& q, nysalt::vector<T, 1>& p, const C& c) const {
    p[0] -= q[0] * 2.0 * c;
  }
#else
  // [mistake]
  template <class T, class C>
  void kick(const nysalt::vector<T, 1>& q, nysalt::vector<T, 1>& p, const C& c) {
    p[0] -= q[0] * 2.0 * c;
  }
  // [/mistake]
#endif
};

int main() {
  const misdeclared system;
  nysalt::make_stepper(system, nysalt::verlet(), 0.1);
}
