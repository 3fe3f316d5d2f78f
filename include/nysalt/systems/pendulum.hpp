// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "nysalt/system.hpp"

namespace nysalt {

/// H = p^2/2 - cos q: unit mass, length and gravity [hairer_lubich_wanner_2006, section I.1.2].
struct pendulum {
  static constexpr int dimension = 1;

  template <class T>
  T potential(const vector<T, 1>& q) const {
    using std::cos;
    return -cos(q[0]);
  }
  template <class T>
  void force(const vector<T, 1>& q, vector<T, 1>& f) const {
    using std::sin;
    f[0] = -sin(q[0]);
  }

  /// Up to 1, that at the bottom: oscillations grow slower with their amplitude.
  std::vector<frequency_band> frequency_bands() const { return {{0.0, 1.0}}; }
  std::string description() const { return "pendulum()"; }
};

}  // namespace nysalt
