// expect: nysalt: s_aia2_for needs the system's highest frequency; give the system frequency_bands(), or use
//   s_aia2(step * frequency)
// SPDX-License-Identifier: BSL-1.0
#include "nysalt/methods/s_aia.hpp"

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
  nysalt::s_aia2_for(of_unknown_frequency(), 0.1);
  // [/mistake]
}
