// SPDX-License-Identifier: BSL-1.0
// energy:K, the energy's error after K steps.
#include <cmath>
#include <stdexcept>
#include <vector>

#include "data_loss.hpp"
#include "nysalt/detail/sentence.hpp"
#include "nysalt/losses/energy_error.hpp"

namespace nysalt::detail {

double scale_of_energies(const model& system, const flow_map_data& data) {
  if (!system.facts().has_energy_over_slopes) {
    throw std::invalid_argument(
        sentence("an energy loss: the potential must be a template over any scalar, got that of {}",
                 describe(system)));
  }
  std::vector<double> squares(data.trajectories(), 0.0);
  for (std::size_t m = 0; m < data.trajectories(); ++m) {
    for (std::size_t n = data.first_of[m]; n < data.first_of[m + 1]; ++n) {
      const double k = kinetic_energy<double>(system, data.start[n].p);
      squares[m] += k * k;
    }
  }
  return 1.0 / std::sqrt(data.share().sum(squares) / static_cast<double>(data.all_pairs()));
}

data_loss of_energies(const loss_inputs& from) {
  return from.in_lanes ? after_steps_of(from, energy_error<lanes>(from.system, from.data))
                       : after_steps_of(from, energy_error<double>(from.system, from.data));
}

constinit const loss_kind energy_loss{.name = "energy", .is_for_sampling = true, .over_data = of_energies};

}  // namespace nysalt::detail
