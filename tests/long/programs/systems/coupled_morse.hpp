// SPDX-License-Identifier: BSL-1.0
#include <cmath>
#include <nysalt/plugin.hpp>

/// Two Morse bonds with an atom in common: K = p1^2 + p2^2 - p1 p2.
struct coupled_morse {
  static constexpr int dimension = 2;
  template <class T>
  T potential(const nysalt::vector<T, 2>& q) const {
    using std::exp;
    const T a = exp(-q[0]) - 1.0;
    const T b = exp(-q[1]) - 1.0;
    return a * a + b * b;
  }
  template <class T>
  T kinetic_energy(const nysalt::vector<T, 2>& p) const {
    return p[0] * p[0] + p[1] * p[1] - p[0] * p[1];
  }
};
NYSALT_SYSTEM(coupled_morse, "two Morse bonds with an atom in common",
              starts([](const coupled_morse&, double spread) {
                const nysalt::vector<double, 2> rest = nysalt::vector<double, 2>::Zero();
                return normal_around<2>({rest, rest}, 0.1 * spread, 0.1 * spread);
              }));
