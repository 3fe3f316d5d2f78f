// expect GNU: no matching function for call to 'cos(const nysalt::dual<double, 1>&)'
// expect Clang: no matching function for call to 'cos'
// SPDX-License-Identifier: BSL-1.0
#include <cmath>

#include "nysalt/method.hpp"
#include "nysalt/methods/classical.hpp"

// std::cos is for double alone; an unqualified cos finds that of dual numbers too.
struct pendulum {
  static constexpr int dimension = 1;
  template <class T>
  T potential(const nysalt::vector<T, 1>& q) const {
#ifdef NYSALT_CONTROL
    using std::cos;
    return -cos(q[0]);
#else
    // [mistake]
    return -std::cos(q[0]);
    // [/mistake]
#endif
  }
};

int main() {
  const pendulum system;
  nysalt::phase_point<double, 1> x{nysalt::vector<double, 1>(1.0), nysalt::vector<double, 1>(0.0)};
  nysalt::make_stepper(system, nysalt::verlet(), 0.1).step(x);
}
