// SPDX-License-Identifier: BSL-1.0
#include <cmath>
#include <nysalt/plugin.hpp>

/// H = sqrt(1 + p^2) + x^2/2 + 2 y^2 + x^4/4.
struct relativistic {
  static constexpr int dimension = 2;
  template <class T>
  T potential(const nysalt::vector<T, 2>& q) const {
    const T xx = q[0] * q[0];
    return xx * 0.5 + q[1] * q[1] * 2.0 + xx * xx * 0.25;
  }
  template <class T>
  T kinetic_energy(const nysalt::vector<T, 2>& p) const {
    using std::sqrt;
    return sqrt(p[0] * p[0] + p[1] * p[1] + 1.0);
  }
};
NYSALT_SYSTEM(relativistic, "a relativistic particle", starts([](const relativistic&, double spread) {
                const nysalt::vector<double, 2> rest = nysalt::vector<double, 2>::Zero();
                return normal_around<2>({rest, rest}, 0.5 * spread, 1.0 * spread);
              }));
