// SPDX-License-Identifier: BSL-1.0
// What methods, and their reference, come to along many trajectories by one measure.
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "nysalt/analysis/method_error.hpp"
#include "nysalt/shard.hpp"

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

namespace detail {

/// What is left of all trajectories by one measure.
struct measured_trajectories {
  /// Nothing yet.
  measured_trajectories(std::size_t methods, std::size_t trajectories, std::size_t checked, bool null,
                        std::size_t perturbed);

  /// Each rank has filled in its own, and all get all. The few that checks are of are in the first leaf.
  void gather(const shard& its);

  std::vector<std::vector<run_score>> runs;  // of each method
  std::vector<double> checks;                // of the reference against its finer self
  std::vector<double> null_model;
  std::vector<double> predictable_until;
  std::vector<double> sizes;  // means over time of what errors are relative to
  std::vector<double> signs;  // of scales; 0 where there is none
};

/// Throws std::invalid_argument where what errors are relative to is 0, or a scale is of both signs.
template <int N, int W>
void require_relative(const measured_trajectories& all, const error_measure<N, W>& measure) {
  const bool is_nothing = measure.relative_to && !(measure.unit(all.sizes) > 0.0);
  const auto differs = [&](double sign) { return sign != all.signs.front(); };
  if (is_nothing || std::ranges::any_of(all.signs, differs)) throw std::invalid_argument(measure.no_scale);
}

template <int N, int W>
trajectory_errors_result summary(const measured_trajectories& all, const error_measure<N, W>& measure,
                                 const auto& reference) {
  require_relative(all, measure);
  trajectory_errors_result result;
  for (const auto& runs : all.runs) result.methods.push_back(error_of_runs(runs, measure, all.sizes));
  result.unit = measure.unit(all.sizes);
  if (!measure.needs_reference) return result;
  result.reference_error = measure.average(all.checks, all.sizes);
  result.reference = reference.description();
  if (!all.null_model.empty()) result.null_model = measure.average(all.null_model, all.sizes);
  if (!all.predictable_until.empty()) result.predictable_until = median(all.predictable_until);
  return result;
}

}  // namespace detail

}  // namespace nysalt
