// expect: nysalt: bath is not of the form `const nysalt::bath& bath() const`; see systems/in_bath.hpp
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
  nysalt::bath bath() const { return nysalt::bath::of_sigma(0.1, 0.0); }
#else
  // [mistake]
  double bath() const { return 0.1; }
  // [/mistake]
#endif
};

int main() {
  const misdeclared system;
  nysalt::make_stepper(system, nysalt::baoab(), 0.1);
}
