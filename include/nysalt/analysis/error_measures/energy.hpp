// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <cmath>
#include <span>
#include <stdexcept>

#include "nysalt/analysis/error_measure.hpp"
#include "nysalt/energy.hpp"

namespace nysalt {

/// The relative error of the energy, sqrt(mean over trajectories and times of ((H - H_0)/|H_0|)^2). It needs
/// no reference. The system is copied. Throws std::invalid_argument, when used, where H_0 is 0.
template <HasEnergy S>
error_measure<S::dimension> energy_measure(const S& system) {
  using numbers = std::span<const double>;
  const auto read = [system](const auto& x, std::span<double> result) {
    result[0] = energy<double>(system, x);
  };
  const auto error = [](numbers seen, numbers, numbers at_start) {
    const double initial = at_start[0];
    if (initial == 0.0) {
      throw std::invalid_argument(
          "the energy error is relative to the energy at the start, which is 0; take other starts, or "
          "another "
          "measure");
    }
    const double relative = (seen[0] - initial) / std::abs(initial);
    return relative * relative;
  };
  return {"energy", 1, read, error, averaging::root_of_all, false};
}

}  // namespace nysalt
