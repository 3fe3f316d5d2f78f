// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <chrono>
#include <functional>
#include <vector>

#include "nysalt/analysis/statistics.hpp"

namespace nysalt {

/// Median seconds of each job over `rounds` rounds in which all take turns, so that a machine that slows
/// down slows all of them. One round more goes first, uncounted.
inline std::vector<double> interleaved_medians(const std::vector<std::function<void()>>& jobs, int rounds) {
  std::vector<std::vector<double>> seconds(jobs.size());
  for (int round = 0; round <= rounds; ++round) {
    for (std::size_t j = 0; j < jobs.size(); ++j) {
      const auto began = std::chrono::steady_clock::now();
      jobs[j]();
      const auto ended = std::chrono::steady_clock::now();
      if (round > 0) seconds[j].push_back(std::chrono::duration<double>(ended - began).count());
    }
  }
  std::vector<double> medians;
  for (const auto& of_job : seconds) medians.push_back(median(of_job));
  return medians;
}

}  // namespace nysalt
