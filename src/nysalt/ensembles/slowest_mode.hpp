// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <algorithm>

#include "nysalt/detail/modal_coordinates.hpp"
#include "nysalt/model.hpp"

namespace nysalt {

/// w with w . q = omega x of the mode that is slowest, so that (w . q)^2 is kT in the mean: what all other
/// means would hide in a system of many modes. Empty where the system declares no modes, or some without a
/// frequency: then the slowest motion is none of them. Cost: that of modes().
inline Eigen::VectorXd slowest_mode(const model& system) {
  if (!has_modes(system)) return {};
  const auto modes = modal_coordinates::of(system);
  const auto omega = std::ranges::min_element(modes->frequencies());
  if (!(*omega > 0.0)) return {};
  const auto slowest = omega - modes->frequencies().begin();
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(modes->size());
  for (const auto& [i, k, heavy, light] : modes->entries()) {
    if (k == slowest) weights[i] = *omega * heavy;
  }
  return weights;
}

}  // namespace nysalt
