// SPDX-License-Identifier: BSL-1.0
#include "nysalt/systems/lennard_jones.hpp"

#include "../bundled_model.hpp"
#include "../bundled_systems.hpp"
#include "../refusal.hpp"
#include "nysalt/ensembles/lennard_jones_law.hpp"

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

std::unique_ptr<bundled_system> make_lennard_jones(std::int64_t space, std::int64_t atoms,
                                                   const surroundings& conditions) {
  constexpr std::int64_t most = 50;  // the minimum of so many atoms is found in a second
  if (space != 2 && space != 3) refuse("--space must be 2 or 3, got {}", space);
  if (atoms < 2 || atoms > most) refuse("--atoms must be at least 2 and at most {}, got {}", most, atoms);
  // The cluster shakes, and no atom leaves.
  const double temperature = 0.1 * conditions.spread * conditions.spread;
  const lennard_jones<> system(space, atoms);
  using law = lennard_jones_law<Eigen::Dynamic, Eigen::Dynamic>;
  const std::vector<named_value> parameters{{"name", "lennard_jones"}, {"atoms", atoms}, {"space", space}};
  return make_bundled(system, conditions, law(system, temperature),
                      {parameters, frequency_at_turning_point(temperature), "energy"});
}

}  // namespace nysalt::program
