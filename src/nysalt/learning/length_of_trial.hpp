// SPDX-License-Identifier: BSL-1.0
// How long the trial run of a fit is.
#pragma once

#include <cstdint>
#include <string>

#include "nysalt/learning/problem.hpp"

namespace nysalt::detail {

/// How many trajectories of how many steps a trial takes.
struct trial_length {
  std::int64_t trajectories = 0;
  std::int64_t steps = 0;
  std::string not_run{};  // why there is none
};

/// As long as runs are planned, from up to 256 starts, but no more force evaluations than half of those that
/// the data and the descents took, or than are cheap for as many trajectories as are enough; fewer before
/// fewer steps.
trial_length length_of_trial(const learning_problem& problem);

}  // namespace nysalt::detail
