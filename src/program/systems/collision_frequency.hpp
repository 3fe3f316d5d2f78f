// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <cmath>

namespace nysalt::program {

/// The highest frequency of two atoms with the potential of Lennard and Jones that meet with a relative
/// momentum of five deviations, 25 kT/2 above the bottom at -1: where they turn, s = r^-6 solves 4 (s^2 - s)
/// = 25 kT/2 - 1. Their frequency is that of 2 V''.
inline double collision_frequency(double temperature) {
  const double s = 0.5 * (1.0 + std::sqrt(12.5 * temperature));
  const double curvature = 4.0 * (156.0 * s * s - 42.0 * s) * std::cbrt(s);
  return std::sqrt(2.0 * curvature);
}

}  // namespace nysalt::program
