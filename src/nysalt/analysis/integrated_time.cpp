// SPDX-License-Identifier: BSL-1.0
#include "nysalt/analysis/integrated_time.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <stdexcept>

namespace nysalt {

integrated_time integrated_autocorrelation_time(std::span<const double> rho) {
  if (rho.size() < 2)
    throw std::invalid_argument("integrated_autocorrelation_time: lags must be one or more, got none");
  integrated_time result;
  for (std::size_t k = 1; k < rho.size(); ++k) {
    result.tau += 2.0 * rho[k];
    result.memory += 2.0 * std::abs(rho[k]);
    result.window = k;
    result.enough = static_cast<double>(k) >= 5.0 * result.memory && result.tau > 0.0;
    if (static_cast<double>(k) >= 5.0 * result.memory) break;
  }
  return result;
}

double effective_sample_size(double samples, const integrated_time& time) {
  if (!time.enough) return std::nan("");
  const double error = time.memory * std::sqrt((4.0 * static_cast<double>(time.window) + 2.0) / samples);
  return samples / std::max(time.tau, 2.0 * error);
}

}  // namespace nysalt
