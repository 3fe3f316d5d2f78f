// SPDX-License-Identifier: BSL-1.0
// When a fit is not to be trusted.
#pragma once

#include <fmt/format.h>

#include <string>

#include "nysalt/derivatives/linear_stability.hpp"
#include "nysalt/family.hpp"
#include "nysalt/learning/fit_summary.hpp"
#include "nysalt/method.hpp"

namespace nysalt::detail {

/// Why a fit should not be used; empty if it may be.
template <Family F, System S>
std::string objection(const S& system, const fit_summary& fit, const parameters_of<F>& theta,
                      bool converged) {
  if (!converged) return "the search did not converge";
  // Sigma is the mean square increment, so to stay where one is has the loss 1 in every coordinate.
  if (!(fit.held_out_loss < static_cast<double>(fit.coordinates_used))) {
    return fmt::format("its held-out loss {:.2e} is no better than that of not moving at all",
                       fit.held_out_loss);
  }
  // Equal to rounding is no objection: a search may begin at the optimum, or with all parameters fixed.
  const double start_loss = fit.held_out_start_loss * (1.0 + 1e-9);
  if (!(fit.held_out_loss <= start_loss || fit.held_out_loss <= 1e-24)) {
    return "on held-out data it is worse than the parameters that the search began with";
  }
  // A tenth would be too much: what is learned is a small correction, and the reference's error adds to it
  // like a bias, however many the data.
  if (fit.reference_checked && !(fit.reference_error <= 0.01 * fit.one_step_error)) {
    return fmt::format("the reference's own error {:.2e} is not small against the one-step error {:.2e}",
                       fit.reference_error, fit.one_step_error);
  }
  if constexpr (HasFrequencyBands<S>) {
    const auto windows = stability_windows(member<F>(theta));
    for (const auto& band : system.frequency_bands()) {
      if (is_stable(windows, fit.step * band.low, fit.step * band.high)) continue;
      return fmt::format("it is not linearly stable for the frequencies {:g} to {:g} of the system", band.low,
                         band.high);
    }
  }
  return {};
}

}  // namespace nysalt::detail
