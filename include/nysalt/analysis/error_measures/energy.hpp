// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <span>

#include "nysalt/analysis/error_measure.hpp"
#include "nysalt/energy.hpp"

namespace nysalt {

/// The relative error of the energy, sqrt(mean over trajectories and times of (H - H_0)^2) over the root mean
/// square of H_0 over trajectories: what each H_0 is divided by is the same for all, as one may pass through
/// 0. It needs no reference. The system is copied. There is no such error where H_0 is 0 on all trajectories.
template <HasEnergy S>
error_measure<S::dimension, lanes_of<S>> energy_measure(const S& system) {
  using T = scalar_of_lanes<lanes_of<S>>;
  using numbers = std::span<const T>;
  const auto read = [system](const auto& x, std::span<T> result) {
    result[0] = energy_in_lanes<T>(system, x);
  };
  const auto error = [](numbers seen, numbers at_start) {
    const T difference = seen[0] - at_start[0];
    return difference * difference;
  };
  const auto square = [](numbers at_start) { return at_start[0] * at_start[0]; };
  return {.name = "energy",
          .width = 1,
          .read = read,
          .error = error,
          .how = averaging::root_of_all,
          .needs_reference = false,
          .no_scale =
              "the energy error is relative to the energy at the starts, which is 0 at all; take other "
              "starts, or another measure",
          .relative_to = square};
}

}  // namespace nysalt
