// SPDX-License-Identifier: BSL-1.0
#include <nysalt/plugin.hpp>

/// Masses between walls.
struct springs {
  static constexpr int dimension = 13;
  template <class T>
  T potential(const nysalt::vector<T, dimension>& q) const {
    T sum = (q[0] * q[0] + q[dimension - 1] * q[dimension - 1]) * 0.5;
    for (int i = 1; i < dimension; ++i) sum += (q[i] - q[i - 1]) * (q[i] - q[i - 1]) * 0.5;
    return sum;
  }
};
NYSALT_SYSTEM(springs, "masses between walls", starts([](const springs&, double spread) {
                constexpr int N = springs::dimension;
                const nysalt::vector<double, N> rest = nysalt::vector<double, N>::Zero();
                return normal_around<N>({rest, rest}, 0.1 * spread, 0.1 * spread);
              }));
