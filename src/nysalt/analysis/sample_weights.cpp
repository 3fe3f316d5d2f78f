// SPDX-License-Identifier: BSL-1.0
#include "nysalt/analysis/sample_weights.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <stdexcept>

namespace nysalt {

sample_weights::sample_weights(double step, std::int64_t samples, double horizon)
    : samples_(samples),
      is_alike_(false),
      last_(horizon / std::abs(step) - static_cast<double>(samples - 1)) {
  constexpr double rounding = 1e-9;  // of horizon/step: as where steps are counted
  const double most = 1.0 + rounding * static_cast<double>(samples);
  if (samples >= 1 && last_ > 0.0 && last_ <= most) return;
  throw std::invalid_argument(fmt::format(
      "sample_weights: horizon must lie within the last of {} steps of {}, got {}", samples, step, horizon));
}

}  // namespace nysalt
