// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <algorithm>
#include <chrono>
#include <functional>
#include <limits>
#include <vector>

#include "nysalt/analysis/statistics.hpp"

namespace nysalt {

/// Seconds of a job over some rounds. What else the machine does only adds: the least is nearest to the job's
/// own, and how far the median lies above it tells how quiet the machine was.
struct timed_job {
  double least = std::numeric_limits<double>::infinity();    ///< of all rounds, in seconds
  double median = std::numeric_limits<double>::quiet_NaN();  ///< of all rounds, in seconds
  int rounds = 0;                                            ///< that count
};

/// Times each job over `rounds` rounds in which all take turns: a machine that slows down slows all of them.
/// One round more goes first, uncounted.
inline std::vector<timed_job> interleaved_seconds(const std::vector<std::function<void()>>& jobs,
                                                  int rounds) {
  std::vector<std::vector<double>> seconds(jobs.size());
  for (int round = 0; round <= rounds; ++round) {
    for (std::size_t j = 0; j < jobs.size(); ++j) {
      const auto began = std::chrono::steady_clock::now();
      jobs[j]();
      const auto ended = std::chrono::steady_clock::now();
      if (round > 0) seconds[j].push_back(std::chrono::duration<double>(ended - began).count());
    }
  }
  std::vector<timed_job> result(jobs.size());
  for (std::size_t j = 0; j < jobs.size() && rounds > 0; ++j) {
    result[j] = {std::ranges::min(seconds[j]), median(seconds[j]), rounds};
  }
  return result;
}

}  // namespace nysalt
