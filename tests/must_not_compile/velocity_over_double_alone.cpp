// expect: nysalt: velocity(p, v) must be differentiable, and takes double only; make it a template
// SPDX-License-Identifier: BSL-1.0
#include "nysalt/derivatives/symplecticity.hpp"
#include "nysalt/methods/classical.hpp"

struct half_differentiable {
  static constexpr int dimension = 1;
  template <class T>
  T potential(const nysalt::vector<T, 1>& q) const {
    return q[0] * q[0];
  }
#ifdef NYSALT_CONTROL
  template <class T>
  void velocity(const nysalt::vector<T, 1>& p, nysalt::vector<T, 1>& v) const {
    v[0] = p[0] * 2.0;
  }
#else
  // [mistake]
  void velocity(const nysalt::vector<double, 1>& p, nysalt::vector<double, 1>& v) const { v[0] = p[0] * 2.0; }
  // [/mistake]
#endif
};

int main() {
  const half_differentiable system;
  const nysalt::phase_point<double, 1> x{nysalt::vector<double, 1>(1.0), nysalt::vector<double, 1>(0.0)};
  return nysalt::symplecticity_defect(system, nysalt::verlet(), 0.1, x) < 1.0;
}
