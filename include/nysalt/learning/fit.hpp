// SPDX-License-Identifier: BSL-1.0
#pragma once

#include "nysalt/learning/problem.hpp"

namespace nysalt {

/// What learning a run_time_family gives.
struct fit {
  Eigen::VectorXd theta;  ///< the learned parameters
  fit_summary summary;    ///< its `usable` says whether to use them
};

// No type of a system is in it: a project may compile learning/solve.hpp apart, once.
#if defined NYSALT_COMPILED_ONCE
fit solve(const learning_problem& problem);
#else
inline fit solve(const learning_problem& problem);
#endif

}  // namespace nysalt
