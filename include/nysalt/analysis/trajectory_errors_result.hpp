// SPDX-License-Identifier: BSL-1.0
// Errors of methods, and of their reference, along many trajectories by one measure.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "nysalt/analysis/method_error.hpp"

namespace nysalt {

/// Errors of all methods by one measure, with null model and reference error.
struct trajectory_errors_result {
  std::vector<method_error> methods;        ///< methods in the order in which they were given
  std::optional<estimate> reference_error;  ///< against its finer self; nothing if no reference was needed
  std::string reference;                    ///< description of the reference, or empty
  std::optional<estimate> null_model;       ///< error of the prediction that nothing moves, if requested
  std::optional<double> predictable_until;  ///< a time, perhaps infinite, if asked for
  double unit = 1.0;                        ///< divisor of the errors: a mean over all trajectories
};

}  // namespace nysalt
