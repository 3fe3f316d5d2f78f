// expect: nysalt: lanes may differ in a comparison, so it cannot choose a branch: write
//   nysalt::select(condition, a, b), or let the system say `static constexpr int lanes = 1;`
// SPDX-License-Identifier: BSL-1.0
#include "nysalt/detail/lockstep.hpp"
#include "nysalt/method.hpp"
#include "nysalt/methods/classical.hpp"

// A wall that one trajectory touches and its neighbour does not: no branch serves both.
struct wall {
  static constexpr int dimension = 1;
#ifdef NYSALT_CONTROL
  static constexpr int lanes = 1;
#endif
  template <class T>
  void force(const nysalt::vector<T, 1>& q, nysalt::vector<T, 1>& f) const {
    // [mistake]
    if (q[0] < 0.0) {
      f[0] = q[0] * -100.0;
    } else {
      f[0] = T(0.0);
    }
    // [/mistake]
  }
};

int main() {
  const wall system;
  const auto stepper = nysalt::make_stepper(system, nysalt::verlet(), 0.01);
  using T = nysalt::scalar_of_lanes<nysalt::lanes_of<wall>>;
  const nysalt::phase_point<T, 1> start{nysalt::vector<T, 1>(T(1.0)), nysalt::vector<T, 1>(T(-1.0))};
  nysalt::lockstep<nysalt::stepper<wall, nysalt::verlet::word>, T> all(stepper, start, 1);
  all.go_on(100);
}
