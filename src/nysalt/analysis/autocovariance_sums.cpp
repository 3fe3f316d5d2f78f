// SPDX-License-Identifier: BSL-1.0
#include "nysalt/analysis/autocovariance_sums.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <stdexcept>

namespace nysalt {

std::size_t checked_lags(int lags) {
  constexpr int most = 100'000;
  if (1 <= lags && lags <= most) return static_cast<std::size_t>(lags);
  throw std::invalid_argument(fmt::format("autocovariance: lags must be 1 to {}, got {}", most, lags));
}

}  // namespace nysalt
