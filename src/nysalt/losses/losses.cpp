// SPDX-License-Identifier: BSL-1.0
// The list of all losses.
#include "nysalt/losses/loss_kind.hpp"

#include <algorithm>
#include <array>

namespace nysalt {

namespace detail {
extern const loss_kind trajectory_loss, state_loss, energy_loss, acceptance_loss, gaussian_acceptance_loss,
    covariance_loss;
}  // namespace detail

std::vector<after_steps_options> after_each_step(int K, int shortest) {
  return {{.steps = {K}, .apart = std::max(1, shortest / 4)}, {.steps = {K}}};
}

std::span<const loss_kind* const> losses() {
  static constexpr std::array all{&detail::trajectory_loss,
                                  &detail::state_loss,
                                  &detail::energy_loss,
                                  &detail::acceptance_loss,
                                  &detail::gaussian_acceptance_loss,
                                  &detail::covariance_loss};
  return all;
}

}  // namespace nysalt
