// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <vector>

#include "nysalt/analysis/statistics.hpp"
#include "nysalt/core/sentence.hpp"
#include "nysalt/integrate.hpp"
#include "nysalt/reference.hpp"

namespace nysalt {

/// Global error at the horizon for steps that are halved, and the observed order.
struct order_measurement {
  std::vector<double> steps;   ///< steps from large to small
  std::vector<double> errors;  ///< largest coordinate; infinite where the run diverged
  /// The slope of ln error by ln step; NaN where it does not show.
  double order = std::numeric_limits<double>::quiet_NaN();
};

/// Integrates to the horizon with horizon/n, n = fewest_steps 2^k, and compares with the reference. The
/// order is the log-log slope over the steps whose error is above the noise: the reference's own error
/// and the rounding of n steps. NaN if fewer than two are; runs that diverged do not count. Use a nonlinear
/// system: on linear ones methods converge too well.
/// Throws std::invalid_argument if fewest_steps < 1, halvings < 0 or the horizon is not finite or 0.
template <SeparableSystem S>
order_measurement convergence_order(const S& system, const method& method, const reference& reference,
                                    const phase_point<double, S::dimension>& start, double horizon,
                                    std::int64_t fewest_steps, int halvings) {
  if (fewest_steps < 1 || halvings < 0 || !std::isfinite(horizon) || horizon == 0.0) {
    throw std::invalid_argument(
        sentence("convergence_order: steps must be >= 1, halvings >= 0 and the horizon finite and not 0, got "
                 "{}, {} and {}",
                 fewest_steps, halvings, horizon));
  }
  auto exact = start;
  reference.advance(system, exact, horizon);
  const double size_of_state = std::max(exact.q.cwiseAbs().maxCoeff(), exact.p.cwiseAbs().maxCoeff());
  const double of_reference = reference_error(system, reference, start, horizon);

  order_measurement result;
  std::vector<double> log_steps;
  std::vector<double> log_errors;
  for (std::int64_t n = fewest_steps, k = 0; k <= halvings; ++k, n *= 2) {
    const double step = horizon / static_cast<double>(n);
    const auto run = integrate(system, method, step, start, n);
    result.steps.push_back(step);
    if (run.diverged_at) {
      result.errors.push_back(std::numeric_limits<double>::infinity());
      continue;
    }
    const auto& end = run.finish;
    const double error =
        std::max((end.q - exact.q).cwiseAbs().maxCoeff(), (end.p - exact.p).cwiseAbs().maxCoeff());
    result.errors.push_back(error);
    const double rounding = std::numeric_limits<double>::epsilon() * size_of_state * static_cast<double>(n) *
                            static_cast<double>(method.letters().length);
    if (error > 20.0 * (of_reference + rounding)) {  // then they bend the slope by less than .1
      log_steps.push_back(std::log(step));
      log_errors.push_back(std::log(error));
    }
  }
  if (log_steps.size() >= 2) result.order = slope(log_steps, log_errors);
  return result;
}

}  // namespace nysalt
