// SPDX-License-Identifier: BSL-1.0
#pragma once

#include "nysalt/learning/problem.hpp"

namespace nysalt {

struct fit {
  Eigen::VectorXd theta;
  fit_summary summary;
};

// No type of a system is in it: a project may compile learning/solve.hpp apart, once.
#if defined NYSALT_COMPILED_ONCE
fit solve(const learning_problem& problem);
#else
inline fit solve(const learning_problem& problem);
#endif

}  // namespace nysalt
