// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <algorithm>
#include <optional>
#include <stdexcept>

#include "nysalt/detail/sentence.hpp"
#include "nysalt/model.hpp"

namespace nysalt {

/// The highest frequency of the system's bands; nothing where it declares none.
inline std::optional<double> highest_frequency(const model& system) {
  double highest = 0.0;
  for (const auto& band : system.frequency_bands()) highest = std::max(highest, band.high);
  return highest > 0.0 ? std::optional(highest) : std::nullopt;
}

/// The step h = z/omega at the highest frequency omega. Throws std::invalid_argument, in the name of who
/// asks, where that is not known.
inline double step_of_frequency(const model& system, double z, const char* who) {
  if (const auto omega = highest_frequency(system)) return z / *omega;
  throw std::invalid_argument(
      sentence("{}: the system must have frequency_bands() for a default step, got {}; give a step", who,
               describe(system)));
}

}  // namespace nysalt
