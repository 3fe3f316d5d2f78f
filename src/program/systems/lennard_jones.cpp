// SPDX-License-Identifier: BSL-1.0
#include "nysalt/systems/lennard_jones.hpp"
#include "collision_frequency.hpp"
#include "nysalt/ensembles/distributions.hpp"
#include "nysalt/system_declaration.hpp"

namespace nysalt::program {

system_declaration declare_lennard_jones() {
  system_declaration result{.name = "lennard_jones",
                            .title = "a cluster of atoms, 4 (r^-12 - r^-6) each pair"};
  result.parameters = {
      {.name = "atoms",
       .usual = 7,
       .meaning = "number of atoms",
       .least = 2,
       .most = 50},  // the cluster of least energy takes a second to find for 50 atoms
      {.name = "space", .usual = 2, .meaning = "number of dimensions, 2 or 3", .least = 2, .most = 3}};
  result.make = [](const parameter_values& values, const bath& in, double spread) {
    // The cluster shakes, and no atom leaves.
    const double temperature = 0.1 * spread * spread;
    const lennard_jones<> system(values.whole("space"), values.whole("atoms"));
    using law = lennard_jones_law<Eigen::Dynamic, Eigen::Dynamic>;
    return detail::made_of(system, in, law(system, temperature), collision_frequency(temperature));
  };
  result.source = "verlet_1967";
  return result;
}

}  // namespace nysalt::program
