// SPDX-License-Identifier: BSL-1.0
#include "nysalt/ensembles/fpu_law.hpp"

#include "../bundled_model.hpp"
#include "../bundled_systems.hpp"
#include "../refusal.hpp"

namespace nysalt::program {

namespace {
template <int Pairs>
std::unique_ptr<bundled_system> make(const fpu_chain<Pairs>& chain, const surroundings& conditions) {
  const std::vector<named_value> parameters{
      {"name", "fpu"}, {"pairs", chain.pairs()}, {"omega", chain.omega()}};
  return make_bundled(chain, conditions, fpu_law<Pairs>(chain, conditions.spread),
                      {parameters, chain.omega(), "stiff_energy"});
}
}  // namespace

std::unique_ptr<bundled_system> make_soft_dominated_fpu(double omega) {
  const fpu_chain<3> chain(omega);
  const std::vector<named_value> parameters{
      {"name", "fpu"}, {"pairs", 3}, {"omega", omega}, {"starts", "soft"}};
  return make_bundled(chain, surroundings{bath::of_sigma(0.0, 0.0), start::law},
                      fpu_law<3>::soft_dominated(chain), {parameters, omega, "stiff_energy"});
}

std::unique_ptr<bundled_system> make_fpu(std::int64_t pairs, double omega, const surroundings& conditions) {
  constexpr std::int64_t most = 1'000'000;  // a state of some tens of megabytes
  if (pairs > most) refuse("--pairs must be at most {}, got {}", most, pairs);
  if (pairs == 3)
    return make(fpu_chain<3>(omega), conditions);  // the paper's, of a size known to the compiler
  return make(fpu_chain<>(pairs, omega), conditions);
}

}  // namespace nysalt::program
