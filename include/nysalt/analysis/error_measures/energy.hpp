// SPDX-License-Identifier: BSL-1.0
#pragma once

#include "nysalt/analysis/error_measure.hpp"
#include "nysalt/model.hpp"

namespace nysalt {

namespace detail {
error_measure energy_measure(const model& system);
}  // namespace detail

/// The relative error of the energy, sqrt(mean over trajectories and times of (H - H_0)^2) over the root mean
/// square of H_0 over trajectories: what each H_0 is divided by is the same for all, as one may pass through
/// 0. It needs no reference. The system is copied. There is no such error where H_0 is 0 on all trajectories.
template <HasEnergy S>
error_measure energy_measure(const S& system) {
  return detail::energy_measure(system);
}

}  // namespace nysalt
