// SPDX-License-Identifier: BSL-1.0
#pragma once

#include "nysalt/learning/problem.hpp"

namespace nysalt {

/// Result of learning a run_time_family.
struct fit {
  Eigen::VectorXd theta;  ///< the learned parameters
  fit_summary summary;    ///< errors and verdict of the fit; `usable` says whether to use the parameters
};

/// The fit of a learning problem, judged: see learn().
fit solve(const learning_problem& problem);

}  // namespace nysalt
