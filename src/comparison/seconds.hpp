// SPDX-License-Identifier: BSL-1.0
// Costs of methods in seconds, measured in interleaved rounds.
#pragma once

#include <vector>

#include "nysalt/analysis/cost_against_error.hpp"
#include "prepared_problem.hpp"

namespace nysalt::program {

struct timed_method {
  nysalt::method method;
  trajectories_plan plan;
  double evaluations_per_time;
};

/// Seconds for one unit of time of one trajectory of a large ensemble, of each method, on this thread; all
/// take turns for some `seconds`, unless a single trajectory takes longer. Rank 0 measures, and the others
/// wait without using the processor; all get the numbers.
std::vector<timed_job> seconds_per_time(const prepared_problem& system,
                                        const std::vector<timed_method>& methods, double seconds);

}  // namespace nysalt::program
