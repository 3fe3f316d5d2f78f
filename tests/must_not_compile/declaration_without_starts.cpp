// expect: nysalt: NYSALT_SYSTEM needs starts(...), once
// SPDX-License-Identifier: BSL-1.0
#include "nysalt/plugin.hpp"

struct well {
  static constexpr int dimension = 1;
  double depth = 1.0;
  template <class T>
  T potential(const nysalt::vector<T, 1>& q) const {
    return depth * q[0] * q[0];
  }
};

inline nysalt::normal_around<1> starts_of_well(const well&) {
  return {{nysalt::vector<double, 1>(0.0), nysalt::vector<double, 1>(0.0)}, 1.0, 1.0};
}

#ifdef NYSALT_CONTROL
NYSALT_SYSTEM(well, "depth q^2", starts(starts_of_well), parameter("depth", &well::depth, "of the well"));
#else
// [mistake]
NYSALT_SYSTEM(well, "depth q^2", parameter("depth", &well::depth, "of the well"));
// [/mistake]
#endif

int main() {}
