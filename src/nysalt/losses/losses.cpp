// SPDX-License-Identifier: BSL-1.0
// The list of all losses.
#include "nysalt/losses/loss_kind.hpp"

#include <array>

namespace nysalt {

namespace detail {
extern const loss_kind state_loss, energy_loss, covariance_loss;
}  // namespace detail

std::span<const loss_kind* const> losses() {
  static constexpr std::array all{&detail::state_loss, &detail::energy_loss, &detail::covariance_loss};
  return all;
}

}  // namespace nysalt
