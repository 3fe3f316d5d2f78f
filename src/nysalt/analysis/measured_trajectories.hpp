// SPDX-License-Identifier: BSL-1.0
// Scores of all trajectories by one measure, gathered over the ranks.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "nysalt/analysis/trajectory_errors_result.hpp"
#include "nysalt/shard.hpp"

namespace nysalt::detail {

/// Scores of all trajectories by one measure.
struct measured_trajectories {
  /// Nothing yet.
  measured_trajectories(std::size_t methods, std::size_t trajectories, std::size_t checked, bool null,
                        std::size_t perturbed);

  /// Each rank has filled in its own, and all get all. The few that checks are of are in the first leaf.
  void gather(const shard& own);
  /// Summary over all trajectories. Throws std::invalid_argument where what errors are relative to is 0, or a
  /// scale is of both signs.
  trajectory_errors_result summary(const error_measure& measure, const std::string& reference) const;

  std::vector<std::vector<run_score>> runs;  // of each method
  std::vector<double> checks;                // of the reference against its finer self
  std::vector<double> null_model;
  std::vector<double> predictable_until;
  std::vector<double> sizes;  // means over time of what errors are relative to
  std::vector<double> signs;  // of scales; 0 where there is none
};

}  // namespace nysalt::detail
