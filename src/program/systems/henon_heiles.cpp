// SPDX-License-Identifier: BSL-1.0
#include "nysalt/systems/henon_heiles.hpp"

#include "../bundled_model.hpp"
#include "../bundled_systems.hpp"
#include "nysalt/ensembles/normal_around.hpp"

namespace nysalt::program {

std::unique_ptr<bundled_system> make_henon_heiles(const surroundings& conditions) {
  // Energies about .02: the motion is bounded below 1/6.
  const vector<double, 2> rest(0.0, 0.0);
  const normal_around<2> law({rest, rest}, 0.1 * conditions.spread, 0.1 * conditions.spread);
  const henon_heiles system;
  return make_bundled(system, conditions, law,
                      {{{"name", "henon_heiles"}}, system.frequency_bands().back().high, "energy"});
}

}  // namespace nysalt::program
