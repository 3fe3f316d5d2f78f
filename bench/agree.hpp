// SPDX-License-Identifier: BSL-1.0
// Before anything is timed: all who race must reach the same end.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <stdexcept>
#include <string_view>

namespace nysalt::bench {

/// Throws std::runtime_error unless the numbers are finite, as many, and equal to `tolerance` of the largest.
inline void require_agreement(std::string_view what, std::span<const double> ours,
                              std::span<const double> theirs, double tolerance) {
  double largest = 0.0;
  double apart = ours.size() == theirs.size() && !ours.empty() ? 0.0 : INFINITY;
  for (std::size_t i = 0; i < ours.size() && std::isfinite(apart); ++i) {
    largest = std::max(largest, std::abs(ours[i]));
    const double here = std::abs(ours[i] - theirs[i]);
    apart = std::isfinite(here) ? std::max(apart, here) : INFINITY;
  }
  if (apart <= tolerance * largest) return;
  throw std::runtime_error(
      fmt::format("{} ends {} away from ours, of {}: it computes something else, and is not timed", what,
                  apart, largest));
}

}  // namespace nysalt::bench
