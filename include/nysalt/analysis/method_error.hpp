// SPDX-License-Identifier: BSL-1.0
// What the runs of one method come to.
#pragma once

#include <cstdint>
#include <iterator>
#include <vector>

#include "nysalt/analysis/error_sum.hpp"
#include "nysalt/divergence.hpp"

namespace nysalt {

/// How far off a method is, and what it costs.
struct method_error {
  estimate error;                                ///< over the trajectories that did not diverge
  std::int64_t diverged = 0;                     ///< number of trajectories that did
  std::vector<diverged_trajectory> diverged_at;  ///< in their order
  double evaluations_per_time = 0.0;             ///< force evaluations per unit time, start-up included
  std::vector<double> of_each{};  ///< what each trajectory has in the error; NaN if it diverged
};

/// From the runs of all trajectories, in their order. What a run cost is counted elsewhere.
template <int N, int W>
method_error error_of_runs(const std::vector<run_score>& runs, const error_measure<N, W>& measure) {
  method_error result;
  std::vector<double> scores;
  for (const auto& run : runs) {
    if (run.diverged_at) result.diverged_at.push_back({std::ssize(scores), *run.diverged_at});
    scores.push_back(run.value);
  }
  result.diverged = std::ssize(result.diverged_at);
  result.error = measure.average(scores);
  result.of_each = measure.parts(scores);
  return result;
}

}  // namespace nysalt
