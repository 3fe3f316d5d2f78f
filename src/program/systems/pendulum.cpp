// SPDX-License-Identifier: BSL-1.0
#include "nysalt/systems/pendulum.hpp"

#include "../bundled_model.hpp"
#include "../bundled_systems.hpp"
#include "nysalt/ensembles/normal_around.hpp"

namespace nysalt::program {

std::unique_ptr<bundled_system> make_pendulum(const surroundings& conditions) {
  // Swings: the pendulum goes over the top from |p| = 2 at the bottom.
  const vector<double, 1> rest(0.0);
  const normal_around<1> law({rest, rest}, 0.5 * conditions.spread, 0.5 * conditions.spread);
  return make_bundled(pendulum(), conditions, law, {{{"name", "pendulum"}}, 1.0, "energy"});
}

}  // namespace nysalt::program
