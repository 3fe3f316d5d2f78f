// SPDX-License-Identifier: BSL-1.0
#include "nysalt/ensembles/given_states.hpp"
#include "nysalt/system_declaration.hpp"
#include "nysalt/systems/textbook.hpp"

namespace nysalt::program {

system_declaration declare_henon_heiles() {
  system_declaration result{.name = "henon_heiles",
                            .title = "two degrees of freedom in a cubic potential, bounded below energy 1/6"};
  result.make = [](const parameter_values&, const bath& in, double spread) {
    // Energies about .02: the motion is bounded below 1/6.
    const vector<double, 2> rest(0.0, 0.0);
    const normal_around<2> law({rest, rest}, 0.1 * spread, 0.1 * spread);
    const henon_heiles system;
    return detail::made_of(system, in, law, system.frequency_bands().back().high);
  };
  result.source = "henon_heiles_1964";
  return result;
}

}  // namespace nysalt::program
