// SPDX-License-Identifier: BSL-1.0
// Errors of methods, and of their reference, along many trajectories by one measure.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "nysalt/analysis/method_error.hpp"

namespace nysalt {

/// By one measure: the errors of all methods, and what they are to be judged by.
struct trajectory_errors_result {
  std::vector<method_error> methods;        ///< in the order in which they were given
  std::optional<estimate> reference_error;  ///< against its finer self; nothing if no reference was needed
  std::string reference;                    ///< its description, or empty
  std::optional<estimate> null_model;       ///< of what stays as it was at the start, if asked for
  std::optional<double> predictable_until;  ///< a time, perhaps infinite, if asked for
  double unit = 1.0;                        ///< what errors are divided by: a mean over all trajectories
};

}  // namespace nysalt
