// SPDX-License-Identifier: BSL-1.0
#include "nysalt/systems/kepler.hpp"

#include "../bundled_model.hpp"
#include "../bundled_systems.hpp"
#include "../refusal.hpp"
#include "nysalt/ensembles/kepler_law.hpp"

namespace nysalt::program {

std::unique_ptr<bundled_system> make_kepler(double eccentricity, const surroundings& conditions) {
  if (!(eccentricity >= 0.0 && eccentricity < 1.0)) {
    refuse("--eccentricity must be at least 0 and below 1, got {}", eccentricity);
  }
  // V'' = 2/r^3 at the pericentre, r = 1 - e.
  const double fastest = std::sqrt(2.0 / std::pow(1.0 - eccentricity, 3));
  const std::vector<named_value> parameters{{"name", "kepler"}, {"eccentricity", eccentricity}};
  return make_bundled(kepler(), conditions, kepler_law(eccentricity), {parameters, fastest, "energy"});
}

}  // namespace nysalt::program
