// SPDX-License-Identifier: BSL-1.0
// What takes the samples of a run: rows of a table, or arrays.
#pragma once

#include <cstdint>
#include <vector>

#include "comparison/sampled_plan.hpp"

namespace nysalt::program {

class sample_sink {
 public:
  virtual ~sample_sink() = default;

  /// Before the first record of a run that begins.
  virtual void begin() {}
  /// More samples of a trajectory, in the order in which a system hands them over.
  virtual void take(std::int64_t trajectory, const record& segment) = 0;
  /// What was taken is handed on.
  virtual void flush() {}
};

/// The observables along trajectory 0, as they are drawn.
struct first_trajectory {
  std::vector<double> t;
  std::vector<std::vector<double>> values;  // of each observable
};

}  // namespace nysalt::program
