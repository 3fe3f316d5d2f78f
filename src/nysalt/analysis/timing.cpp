// SPDX-License-Identifier: BSL-1.0
#include "nysalt/analysis/timing.hpp"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <functional>
#include <vector>

#include "nysalt/analysis/statistics.hpp"

namespace nysalt {

std::vector<timed_job> interleaved_seconds(const std::vector<std::function<void()>>& jobs, int rounds) {
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
