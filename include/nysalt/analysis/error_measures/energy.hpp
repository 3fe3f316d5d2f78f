// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <cmath>
#include <span>

#include "nysalt/analysis/error_measure.hpp"
#include "nysalt/energy.hpp"

namespace nysalt {

/// The relative error of the energy, sqrt(mean over trajectories and times of ((H - H_0)/|H_0|)^2). It needs
/// no reference. The system is copied. There is no such error where H_0 is 0.
template <HasEnergy S>
error_measure<S::dimension, lanes_of<S>> energy_measure(const S& system) {
  using T = scalar_of_lanes<lanes_of<S>>;
  using numbers = std::span<const T>;
  const auto read = [system](const auto& x, std::span<T> result) {
    result[0] = energy_in_lanes<T>(system, x);
  };
  const auto error = [](numbers seen, numbers at_start) {
    using std::abs;
    const T relative = (seen[0] - at_start[0]) / abs(at_start[0]);
    return relative * relative;
  };
  const auto scale = [](numbers at_start) { return at_start[0]; };
  return {
      "energy",
      1,
      read,
      error,
      averaging::root_of_all,
      false,
      scale,
      "the energy error is relative to the energy at the start, which is 0; take other starts, or another "
      "measure"};
}

}  // namespace nysalt
