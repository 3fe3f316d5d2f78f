// SPDX-License-Identifier: BSL-1.0
#include "../bundled_model.hpp"
#include "../bundled_systems.hpp"
#include "nysalt/ensembles/normal_around.hpp"
#include "nysalt/systems/harmonic_oscillator.hpp"

namespace nysalt::program {

std::unique_ptr<bundled_system> make_oscillator(double omega, const surroundings& conditions) {
  const harmonic_oscillator oscillator(omega);
  // Of energy kT = 1 in the mean.
  const vector<double, 1> rest(0.0);
  const normal_around<1> law({rest, rest}, conditions.spread / omega, conditions.spread);
  const std::vector<named_value> parameters{{"name", "oscillator"}, {"omega", omega}};
  return make_bundled<true>(oscillator, conditions, law, {parameters, omega, "energy"});
}

}  // namespace nysalt::program
