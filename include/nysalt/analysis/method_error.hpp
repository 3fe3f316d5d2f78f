// SPDX-License-Identifier: BSL-1.0
// Errors of the runs of one method.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "nysalt/analysis/error_sum.hpp"
#include "nysalt/analysis/tail.hpp"
#include "nysalt/detail/divergence.hpp"

namespace nysalt {

/// The quantiles of errors that are reported.
inline constexpr std::array shown_quantiles{0.05, 0.25, 0.5, 0.75, 0.95};

/// Spread of the errors of single trajectories about the one number that is made of them: each is the error
/// that this trajectory would have without the others, in the unit of the whole.
struct distribution_of_errors {
  tail largest{};     ///< largest score; the error is the mean of the scores
  estimate median{};  ///< median with its standard error
  std::array<double, shown_quantiles.size()> quantiles{};  ///< scores at shown_quantiles
};

/// Error and cost of a method.
struct method_error {
  estimate error;                                ///< mean over the trajectories that did not diverge
  std::int64_t diverged = 0;                     ///< number of trajectories that diverged
  std::vector<diverged_trajectory> diverged_at;  ///< steps of divergence, in the order of the trajectories
  double evaluations_per_time = 0.0;             ///< force evaluations per unit time, start-up included
  std::vector<double> of_each{};    ///< contribution of each trajectory to the error; NaN if it diverged
  std::vector<double> own{};        ///< the error of each by itself, in the unit of the whole; NaN likewise
  distribution_of_errors spread{};  ///< spread of the trajectories that did not diverge
};

/// Error of a method from the runs of all trajectories, in their order, and what their errors are relative
/// to. What a run cost is counted elsewhere.
method_error error_of_runs(const std::vector<run_score>& runs, const error_measure& measure,
                           std::span<const double> sizes = {});

}  // namespace nysalt
