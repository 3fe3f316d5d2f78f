// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <algorithm>
#include <chrono>
#include <functional>
#include <limits>
#include <vector>

namespace nysalt {

/// Seconds of each job, the least over `rounds` rounds in which all take turns: what else the machine does
/// only adds, and a machine that slows down slows all of them. One round more goes first, uncounted. Infinite
/// without a round.
inline std::vector<double> interleaved_seconds(const std::vector<std::function<void()>>& jobs, int rounds) {
  std::vector<double> least(jobs.size(), std::numeric_limits<double>::infinity());
  for (int round = 0; round <= rounds; ++round) {
    for (std::size_t j = 0; j < jobs.size(); ++j) {
      const auto began = std::chrono::steady_clock::now();
      jobs[j]();
      const auto ended = std::chrono::steady_clock::now();
      const double seconds = std::chrono::duration<double>(ended - began).count();
      if (round > 0) least[j] = std::min(least[j], seconds);
    }
  }
  return least;
}

}  // namespace nysalt
