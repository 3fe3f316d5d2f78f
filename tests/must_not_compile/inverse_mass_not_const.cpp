// expect: nysalt: inverse_mass is not of the form `double inverse_mass(Eigen::Index i) const`
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
  double inverse_mass(Eigen::Index) const { return 0.5; }
#else
  // [mistake]
  double inverse_mass(Eigen::Index) { return 0.5; }
  // [/mistake]
#endif
};

int main() {
  const misdeclared system;
  nysalt::make_stepper(system, nysalt::verlet(), 0.1);
}
