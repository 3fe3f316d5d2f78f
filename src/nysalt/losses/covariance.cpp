// SPDX-License-Identifier: BSL-1.0
// covariance, the loss of the stationary distribution of a thermostatted word: no data are needed.
#include <stdexcept>

#include "data_loss.hpp"
#include "nysalt/detail/sentence.hpp"
#include "nysalt/losses/stationary_covariance.hpp"

namespace nysalt::detail {

namespace {
objective of_law(const model& system, const run_time_family& family, double step) {
  if (!has_modes(system) || !system.bath().acts()) {
    throw std::invalid_argument(sentence(
        "covariance loss: the system must be in a bath and declare modes(), got {}", describe(system)));
  }
  return objective_of(stationary_covariance(system, family.letters, step), family);
}
}  // namespace

constinit const loss_kind covariance_loss{.name = "covariance",
                                          .counts_steps = false,
                                          .needs_modes = true,
                                          .needs_bath = true,
                                          .over_data = of_states,
                                          .without_data = of_law};

}  // namespace nysalt::detail
