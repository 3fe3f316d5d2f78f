// SPDX-License-Identifier: BSL-1.0
#include "../bundled_model.hpp"
#include "../bundled_systems.hpp"
#include "../refusal.hpp"
#include "nysalt/ensembles/normal_around.hpp"
#include "nysalt/systems/phi4_chain.hpp"

namespace nysalt::program {

std::unique_ptr<bundled_system> make_phi4(std::int64_t masses, const surroundings& conditions) {
  constexpr std::int64_t most = 1000;  // the modes of a chain take a full matrix
  if (masses > most) refuse("--masses must be at most {}, got {}", most, masses);
  const phi4_chain<> chain(masses);
  using law = normal_around<Eigen::Dynamic>;
  const Eigen::VectorXd rest = Eigen::VectorXd::Zero(masses);
  // Near kT = 1, where springs and wells matter alike.
  const double q = 0.5 * conditions.spread;
  const double p = conditions.spread;
  // A well may hold what a mass has that starts at five deviations of both.
  const double well_energy = 12.5 * p * p + std::pow(5.0 * q, 4) / 4.0;
  const double fastest = chain.frequency_bands(well_energy).back().high;
  const std::vector<named_value> parameters{{"name", "phi4"}, {"masses", masses}};
  return make_bundled(chain, conditions, law({rest, rest}, q, p), {parameters, fastest, "energy"});
}

}  // namespace nysalt::program
