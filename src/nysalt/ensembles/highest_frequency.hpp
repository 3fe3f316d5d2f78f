// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <algorithm>
#include <optional>

#include "nysalt/model.hpp"

namespace nysalt {

/// The highest frequency of the system's bands; nothing where it declares none.
inline std::optional<double> highest_frequency(const model& system) {
  double highest = 0.0;
  for (const auto& band : system.frequency_bands()) highest = std::max(highest, band.high);
  return highest > 0.0 ? std::optional(highest) : std::nullopt;
}

}  // namespace nysalt
