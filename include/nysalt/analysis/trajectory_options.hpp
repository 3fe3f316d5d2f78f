// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>

#include "nysalt/communicators/one_rank.hpp"
#include "nysalt/detail/divergence.hpp"
#include "nysalt/lanes.hpp"

namespace nysalt {

/// Number, length, seed and threads of the trajectories to compare.
struct trajectory_options {
  double step;                      ///< samples are at t_i = i step, i = 1..steps
  std::int64_t steps;               ///< steps of each trajectory
  std::int64_t trajectories = 400;  ///< independent starts
  std::uint64_t seed = 1;           ///< seed of the starts and the noise
  int threads = 1;                  ///< changes no bit
  std::function<void(std::int64_t done)> progress =
      {};                   ///< progress callback, after some trajectories; calls do not overlap
  bool null_model = false;  ///< whether to measure it; what is left out costs nothing
  /// Relative, of starts: how long are trajectories predictable? Nothing: that is not measured.
  std::optional<double> perturbation = {};
  const communicator* ranks = &one_rank;  ///< ranks that share the trajectories; changes no bit
  /// Errors are means over [0, horizon], which ends within the last step (sample_weights), so that methods of
  /// other steps are judged over the same time. Nothing: over all samples alike.
  std::optional<double> horizon = {};
};

/// Throws std::invalid_argument unless there are steps and trajectories, and a score of each method, measure
/// and trajectory, and an interval of samples of `width` numbers (of all measures) for each method and
/// thread, fit into the memory of a rank: the scores of all trajectories come to each of them.
void require_room(const trajectory_options& options, std::size_t methods, std::size_t width,
                  std::size_t measures = 1);

}  // namespace nysalt
