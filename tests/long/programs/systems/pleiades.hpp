// SPDX-License-Identifier: BSL-1.0
#include <cmath>
#include <nysalt/plugin.hpp>

/// The Pleiades problem [hairer_norsett_wanner_1993, II.10]: seven stars of masses 1 to 7 in a plane, the
/// first seven coordinates are x, the others y.
struct pleiades {
  static constexpr int dimension = 14;
  double inverse_mass(Eigen::Index i) const { return 1.0 / static_cast<double>(i % 7 + 1); }
  template <class T>
  T potential(const nysalt::vector<T, 14>& q) const {
    using std::sqrt;
    T v(0.0);
    for (int i = 0; i < 7; ++i)
      for (int j = i + 1; j < 7; ++j) {
        const T dx = q[i] - q[j], dy = q[i + 7] - q[j + 7];
        v = v - static_cast<double>((i + 1) * (j + 1)) / sqrt(dx * dx + dy * dy);
      }
    return v;
  }
};
NYSALT_SYSTEM(pleiades, "seven stars", starts([](const pleiades&, double) {
                nysalt::vector<double, 14> q, p = nysalt::vector<double, 14>::Zero();
                q << 3, 3, -1, -3, 2, -2, 2, 3, -3, 2, 0, 0, -4, 4;
                p[5] = 6 * 1.75;
                p[6] = 7 * -1.5;
                p[10] = 4 * -1.25;
                p[11] = 5 * 1.0;
                return normal_around<14>({q, p}, 0.0, 0.0);
              }));
