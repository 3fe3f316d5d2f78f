// SPDX-License-Identifier: BSL-1.0
#include "nysalt/systems/linear_chain.hpp"

#include "../bundled_model.hpp"
#include "../bundled_systems.hpp"
#include "../refusal.hpp"
#include "nysalt/ensembles/normal_around.hpp"

namespace nysalt::program {

std::unique_ptr<bundled_system> make_linear_chain(std::int64_t masses, double spring,
                                                  const surroundings& conditions) {
  constexpr std::int64_t most = 1000;  // the modes of a chain are found from a full matrix: seconds
  if (masses > most) refuse("--masses must be at most {}, got {}", most, masses);
  const auto chain = linear_chain::between_walls(masses, spring);
  const double fastest = chain.frequency_bands().back().high;
  using law = normal_around<Eigen::Dynamic>;
  const Eigen::VectorXd rest = Eigen::VectorXd::Zero(masses);
  const std::vector<named_value> parameters{{"name", "linear_chain"}, {"masses", masses}, {"spring", spring}};
  return make_bundled<true>(chain, conditions,
                            law({rest, rest}, conditions.spread / fastest, conditions.spread),
                            {parameters, fastest, "energy"});
}

}  // namespace nysalt::program
