// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

#include "nysalt/integrate.hpp"

namespace nysalt {

/// (H - H_0)/|H_0| along a trajectory: bounded for a symplectic method, and without a trend.
struct energy_record {
  double largest = 0.0;                     ///< maximum of |H - H_0|/|H_0|
  double drift = 0.0;                       ///< slope of the energy error per unit time, least squares
  std::optional<std::int64_t> diverged_at;  ///< step of divergence, if any
};

/// Runs `steps` steps and reads the energy every `every` of them. |H_0| below 1e-300 counts as 1.
/// Memory: none that grows with the steps.
template <HasEnergy S>
energy_record energy_drift(const S& system, const method& method, double step,
                           const phase_point<double, S::dimension>& start, std::int64_t steps,
                           std::int64_t every = 1) {
  const double initial = energy<double>(system, start);
  const double unit = std::abs(initial) < 1e-300 ? 1.0 : std::abs(initial);
  energy_record result;
  // Least squares with running means: sums of products about the means, which lose no digits to cancellation.
  double samples = 0.0;
  double mean_t = 0.0;
  double mean_error = 0.0;
  double tt = 0.0;
  double te = 0.0;
  const auto watch = [&](std::int64_t, double t, const auto& x) {
    const double error = (energy<double>(system, x) - initial) / unit;
    result.largest = std::max(result.largest, std::abs(error));
    samples += 1.0;
    const double from_mean = t - mean_t;
    mean_t += from_mean / samples;
    mean_error += (error - mean_error) / samples;
    tt += from_mean * (t - mean_t);
    te += from_mean * (error - mean_error);
  };
  result.diverged_at = integrate(system, method, step, start, steps, watch, every).diverged_at;
  if (samples > 1.0) result.drift = te / tt;
  return result;
}

}  // namespace nysalt
