// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <stdexcept>

#include "nysalt/communicators/alone.hpp"
#include "nysalt/divergence.hpp"
#include "nysalt/lanes.hpp"

namespace nysalt {

/// Which trajectories are compared, for how long, and by whom.
struct trajectory_options {
  double step;                                           ///< samples are at t_i = i step, i = 1..steps
  std::int64_t steps;                                    ///< of each trajectory
  std::int64_t trajectories = 400;                       ///< independent starts
  std::uint64_t seed = 1;                                ///< of the starts and the noise
  int threads = 1;                                       ///< changes no bit
  std::function<void(std::int64_t done)> progress = {};  ///< after some trajectories; never two calls at once
  bool null_model = false;  ///< whether to measure it; what is left out costs nothing
  /// Relative, of starts: how long are trajectories predictable? Nothing: that is not measured.
  std::optional<double> perturbation = {};
  const communicator* ranks = &alone;  ///< who share the trajectories; changes no bit
  /// Errors are means over [0, horizon], which ends within the last step (sample_weights), so that methods of
  /// other steps are judged over the same time. Nothing: over all samples alike.
  std::optional<double> horizon = {};
};

/// Throws std::invalid_argument unless there are steps and trajectories, and a score of each method, measure
/// and trajectory, and a stretch of samples of `width` numbers (of all measures) for each method and thread,
/// fit into the memory of a rank: the scores of all trajectories come to each of them.
inline void require_room(const trajectory_options& options, std::size_t methods, std::size_t width,
                         std::size_t measures = 1) {
  if (options.steps < 1 || options.trajectories < 1) {
    throw std::invalid_argument(
        fmt::format("trajectory_errors: {} trajectories of {} steps: at least one of each is needed",
                    options.trajectories, options.steps));
  }
  const std::size_t references = options.perturbation ? 3 : 2;
  const double stretches = static_cast<double>(methods + references) * options.threads * default_lanes;
  const double numbers = stretches * static_cast<double>(steps_between_checks) * static_cast<double>(width);
  const std::size_t scored = methods + (options.null_model ? 1 : 0);
  const double scores = static_cast<double>(options.trajectories) * static_cast<double>(scored * measures);
  if (numbers > 1e9 || scores > 1e8) {
    throw std::invalid_argument(
        fmt::format("trajectory_errors: {} trajectories with {} numbers a sample, on {} threads, do not fit "
                    "into memory; take fewer",
                    options.trajectories, width, options.threads));
  }
}

}  // namespace nysalt
