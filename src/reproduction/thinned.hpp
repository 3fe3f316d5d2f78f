// SPDX-License-Identifier: BSL-1.0
// Data of table 1: pairs of a large step, from data of a small one.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "nysalt/flow_map_data.hpp"

namespace nysalt::program::paper {

/// The same trajectories at `factor` times the step, the last pair ending at `horizon` at most. Checks of the
/// reference are of the old step: none. For data without noise.
inline flow_map_data thinned(const flow_map_data& data, std::size_t factor, double horizon) {
  flow_map_data result = data;
  result.step = data.step * static_cast<double>(factor);
  result.start.clear();
  result.finish.clear();
  result.finer.clear();
  result.first_of = {0};
  const auto wanted = static_cast<std::size_t>(std::llround(horizon / data.step));
  for (std::size_t m = 0; m < data.trajectories(); ++m) {
    const std::size_t end = std::min(data.first_of[m + 1], data.first_of[m] + wanted);
    for (std::size_t n = data.first_of[m]; n + factor <= end; n += factor) {
      result.start.push_back(data.start[n]);
      result.finish.push_back(data.finish[n + factor - 1]);
    }
    result.first_of.push_back(result.pairs());
  }
  return result;
}

}  // namespace nysalt::program::paper
