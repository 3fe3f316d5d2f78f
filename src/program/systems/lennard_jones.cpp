// SPDX-License-Identifier: BSL-1.0
#include <cmath>

#include "nysalt/ensembles/lennard_jones_law.hpp"
#include "nysalt/system_declaration.hpp"
#include "nysalt/systems/lennard_jones.hpp"

namespace nysalt::program {

namespace {

/// Of two atoms that meet with a relative momentum of five deviations, 25 kT/2 above the bottom at -1: where
/// they turn, s = r^-6 solves 4 (s^2 - s) = 25 kT/2 - 1. Their frequency is that of 2 V''.
double frequency_at_turning_point(double temperature) {
  const double s = 0.5 * (1.0 + std::sqrt(12.5 * temperature));
  const double curvature = 4.0 * (156.0 * s * s - 42.0 * s) * std::cbrt(s);
  return std::sqrt(2.0 * curvature);
}

}  // namespace

system_declaration declare_lennard_jones() {
  system_declaration result{.name = "lennard_jones",
                            .title = "a cluster of atoms, 4 (r^-12 - r^-6) each pair"};
  result.parameters = {{.name = "atoms",
                        .usual = 7,
                        .meaning = "of the cluster",
                        .least = 2,
                        .most = 50},  // the cluster of least energy takes a second to find for 50 atoms
                       {.name = "space", .usual = 2, .meaning = "dimensions: 2 or 3", .least = 2, .most = 3}};
  result.make = [](const parameter_values& values, const bath& in, double spread) {
    // The cluster shakes, and no atom leaves.
    const double temperature = 0.1 * spread * spread;
    const lennard_jones<> system(values.whole("space"), values.whole("atoms"));
    using law = lennard_jones_law<Eigen::Dynamic, Eigen::Dynamic>;
    return detail::made_of(system, in, law(system, temperature), frequency_at_turning_point(temperature));
  };
  result.source = "verlet_1967";
  return result;
}

}  // namespace nysalt::program
