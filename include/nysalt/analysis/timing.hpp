// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <functional>
#include <limits>
#include <vector>

#include "nysalt/analysis/statistics.hpp"

namespace nysalt {

/// Seconds of a job over some rounds. What else the machine does only adds: the least is nearest to the job's
/// own, and how far the median lies above it measures how quiet the machine was.
struct timed_job {
  double least = std::numeric_limits<double>::infinity();    ///< minimum over all rounds, in seconds
  double median = std::numeric_limits<double>::quiet_NaN();  ///< median over all rounds, in seconds
  int rounds = 0;                                            ///< rounds that count
};

/// Times each job over `rounds` rounds in which all take turns: a machine that slows down slows all of them.
/// One round more goes first, uncounted.
std::vector<timed_job> interleaved_seconds(const std::vector<std::function<void()>>& jobs, int rounds);

}  // namespace nysalt
