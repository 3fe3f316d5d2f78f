// SPDX-License-Identifier: BSL-1.0
#include "nysalt/losses/energy_error.hpp"

#include <cmath>
#include <stdexcept>
#include <vector>

#include "nysalt/detail/sentence.hpp"

namespace nysalt::detail {

double scale_of_energies(const model& system, const flow_map_data& data) {
  if (!system.facts().has_energy_over_slopes) {
    throw std::invalid_argument(
        sentence("an energy loss needs the potential of {} as a template over any scalar", describe(system)));
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

}  // namespace nysalt::detail
