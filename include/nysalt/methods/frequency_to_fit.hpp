// SPDX-License-Identifier: BSL-1.0
// The frequency whose phase is to be kept.
#pragma once

#include <algorithm>

#include "nysalt/system.hpp"

namespace nysalt {

namespace detail {
/// The highest frequency of the modes; of systems that declare none, the end of the highest band.
template <System S>
double frequency_to_fit(const S& system) {
  double highest = 0.0;
  if constexpr (HasModes<S>) {
    if (has_modes(system)) return system.modes().frequencies.maxCoeff();
  }
  if constexpr (HasFrequencyBands<S>) {
    for (const auto& band : system.frequency_bands()) highest = std::max(highest, band.high);
  }
  return highest;
}
}  // namespace detail

}  // namespace nysalt
