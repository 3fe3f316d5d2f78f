// SPDX-License-Identifier: BSL-1.0
#include "nysalt/systems/lennard_jones_liquid.hpp"

#include <algorithm>
#include <cmath>

#include "collision_frequency.hpp"
#include "nysalt/ensembles/distributions.hpp"
#include "nysalt/system_declaration.hpp"

namespace nysalt::program {

system_declaration declare_lennard_jones_liquid() {
  system_declaration result{.name = "lennard_jones_liquid",
                            .title = "atoms in a periodic cube, 4 (r^-12 - r^-6) each pair within a cut-off"};
  result.parameters = {
      {.name = "atoms", .usual = 108, .meaning = "number of atoms", .least = 2, .most = 1e5, .is_size = true},
      {.name = "density",
       .usual = 0.8442,
       .meaning = "number of atoms in a unit of volume",
       .is_positive = true},
      {.name = "cutoff", .usual = 2.2, .meaning = "distance from which pairs have no force", .least = 1.0},
      {.name = "smoothness",
       .usual = 3,
       .meaning = "number of derivatives of a pair's potential that are continuous at the cut-off",
       .least = 0,
       .most = 3}};
  result.make = [](const parameter_values& values, const bath& in, double spread) {
    const std::int64_t atoms = values.whole("atoms");
    const double density = values.real("density");
    lennard_jones_liquid_options options{.cutoff = values.real("cutoff"),
                                         .smoothness = static_cast<int>(values.whole("smoothness"))};
    // Bits do not depend on the skin: where the box has no room for the usual one, the largest that it has.
    // With less than this the list would be made at nearly every step: a longer cut-off is refused.
    const double room = 0.5 * std::cbrt(static_cast<double>(atoms) / density) - options.cutoff;
    if (room > 0.01) options.skin = std::min(options.skin, room * (1.0 - 1e-12));
    const lennard_jones_liquid system(atoms, density, options);
    // A crystal that melts, and has kT of some 0.72 then at the usual density.
    const double temperature = 1.44 * spread * spread;
    auto problem = detail::made_of(system, in, lennard_jones_liquid_law(system, temperature),
                                   collision_frequency(temperature));
    // A step of .0005 of time. At one of .002 srkn11b errs by 2e-12 of the state on [0, .5].
    problem.fine_angle = 0.05;
    return problem;
  };
  result.source = "verlet_1967";
  return result;
}

}  // namespace nysalt::program
