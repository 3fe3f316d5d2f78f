// SPDX-License-Identifier: BSL-1.0
#include "nysalt/analysis/ensemble_statistics.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <stdexcept>

namespace nysalt {

std::int64_t samples_of_trajectory(const ensemble_options& options, const statistics_wanted& wanted) {
  constexpr std::int64_t most = std::int64_t{1} << 48U;  // the number of trajectories with noise of their own
  if (options.trajectories < 1 || options.trajectories > most || options.first < 0 || options.steps < 0 ||
      options.every < 1 || wanted.from < 0 || wanted.from > options.steps) {
    throw std::invalid_argument(fmt::format(
        "ensemble_statistics: trajectories must be 1 to 2^48, first and steps >= 0, every >= 1, and from 0 "
        "to steps, got trajectories {}, first {}, steps {}, every {} and from {}",
        options.trajectories, options.first, options.steps, options.every, wanted.from));
  }
  const std::int64_t before = wanted.from == 0 ? 0 : (wanted.from - 1) / options.every + 1;
  const std::int64_t samples = options.steps / options.every + 1 - before;
  if (samples > wanted.lags.value_or(0)) return samples;
  throw std::invalid_argument(
      fmt::format("ensemble_statistics: samples along a trajectory must exceed the lags, got {} "
                  "samples for {} lags; take more steps or fewer lags",
                  samples, wanted.lags.value_or(0)));
}

}  // namespace nysalt
