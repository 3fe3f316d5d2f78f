// expect GNU: required for the satisfaction of 'System<S>' [with S = of_unknown_size]
// expect GNU: 'dimension' is not a member of 'of_unknown_size'
// expect Clang: because 'of_unknown_size' does not satisfy 'System'
// expect Clang: no member named 'dimension' in 'of_unknown_size'
// SPDX-License-Identifier: BSL-1.0
#include "nysalt/method.hpp"
#include "nysalt/methods/classical.hpp"

struct of_unknown_size {
#ifdef NYSALT_CONTROL
  static constexpr int dimension = 1;
#endif
  template <class T>
  T potential(const nysalt::vector<T, 1>& q) const {
    return q[0] * q[0];
  }
};

int main() {
  const of_unknown_size system;
  nysalt::make_stepper(system, nysalt::verlet(), 0.1);
}
