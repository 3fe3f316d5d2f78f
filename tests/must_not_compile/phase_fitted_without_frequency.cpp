// expect: nysalt: phase_fitted_for needs the system's highest frequency; give the system modes() or
//   frequency_bands(), or use phase_fitted(step * frequency)
// SPDX-License-Identifier: BSL-1.0
#include "nysalt/families/fg_chin.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/methods/phase_fitted.hpp"

struct of_unknown_frequency {
  static constexpr int dimension = 1;
  template <class T>
  T potential(const nysalt::vector<T, 1>& q) const {
    return q[0] * q[0];
  }
#ifdef NYSALT_CONTROL
  std::vector<nysalt::frequency_band> frequency_bands() const { return {{1.0, 1.5}}; }
#endif
};

int main() {
  // [mistake]
  nysalt::phase_fitted_for<nysalt::fg_chin, nysalt::chin4a>(of_unknown_frequency(), 0.1);
  // [/mistake]
}
