// SPDX-License-Identifier: BSL-1.0
#include "nysalt/analysis/trajectory_options.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <stdexcept>

#include "nysalt/detail/divergence.hpp"
#include "nysalt/lanes.hpp"

namespace nysalt {

void require_room(const trajectory_options& options, std::size_t methods, std::size_t width,
                  std::size_t measures) {
  if (options.steps < 1 || options.trajectories < 1) {
    throw std::invalid_argument(fmt::format(
        "trajectory_errors: trajectories and steps must be at least 1, got {} trajectories of {} steps",
        options.trajectories, options.steps));
  }
  const std::size_t references = options.perturbation ? 3 : 2;
  const double intervals = static_cast<double>(methods + references) * options.threads * default_lanes;
  const double numbers = intervals * static_cast<double>(steps_between_checks) * static_cast<double>(width);
  const std::size_t scored = methods + (options.null_model ? 1 : 0);
  const double scores = static_cast<double>(options.trajectories) * static_cast<double>(scored * measures);
  if (numbers > 1e9 || scores > 1e8) {
    throw std::invalid_argument(
        fmt::format("trajectory_errors: samples must fit into memory, got {} trajectories with {} numbers a "
                    "sample, on {} threads; take fewer",
                    options.trajectories, width, options.threads));
  }
}

}  // namespace nysalt
