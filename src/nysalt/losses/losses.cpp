// SPDX-License-Identifier: BSL-1.0
// The list of all losses.
#include "nysalt/losses/loss_kind.hpp"

#include <algorithm>
#include <array>

#include "data_loss.hpp"

namespace nysalt {

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
