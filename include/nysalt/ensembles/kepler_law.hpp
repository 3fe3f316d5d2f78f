// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <string>

#include "nysalt/ensemble.hpp"
#include "nysalt/noises/counter_based.hpp"
#include "nysalt/systems/kepler.hpp"

namespace nysalt {

/// Ellipses of semi-major axis 1 and one eccentricity, run through counterclockwise: their orientation is
/// uniform, and so is the time since the pericentre, as the mean anomaly M. With E - e sin E = M,
///   q = (cos E - e, sqrt(1 - e^2) sin E),  p = (-sin E, sqrt(1 - e^2) cos E)/(1 - e cos E)
/// [hairer_lubich_wanner_2006, section I.2], turned. All have H = -1/2.
class kepler_law {
 public:
  /// Throws std::invalid_argument unless 0 <= eccentricity < 1.
  explicit kepler_law(double eccentricity);

  phase_point<double, 2> operator()(std::uint64_t seed, std::uint64_t n) const;
  std::string description() const;

 private:
  /// E of M in -pi..pi, by Newton's method from +-pi: where E - e sin E - M has a curvature of one sign, it
  /// comes nearer from one side until rounding stops it.
  double eccentric_anomaly(double mean) const;

  double eccentricity_;
};

}  // namespace nysalt
