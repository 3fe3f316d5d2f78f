// expect GNU: required for the satisfaction of 'SeparableSystem<S>' [with S = incomplete]
// expect Clang: because 'incomplete' does not satisfy 'SeparableSystem'
// SPDX-License-Identifier: BSL-1.0
#include "nysalt/reference.hpp"
#include "nysalt/references/fine_steps.hpp"

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
  const nysalt::phase_point<double, 1> x{nysalt::vector<double, 1>(1.0), nysalt::vector<double, 1>(0.0)};
  return nysalt::reference_error(system, nysalt::fine_steps<>(0.01), x, 0.1) < 1.0 ? 0 : 1;
}
