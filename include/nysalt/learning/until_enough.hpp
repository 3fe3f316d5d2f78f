// SPDX-License-Identifier: BSL-1.0
// How many trajectories are enough: until what is still uncertain hardly matters.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "nysalt/learning/fit_summary.hpp"

namespace nysalt {

/// When to stop.
struct enough_options {
  double share = 0.01;          ///< of the loss, that the uncertainty of the parameters may add to it
  std::int64_t most = 100'000;  ///< number of trajectories beyond which it does not go
};

/// How a fit came to its number of trajectories.
struct enough_course {
  /// One fit on the way.
  struct stop {
    std::int64_t trajectories;  ///< how many it had
    double share;               ///< its fit_summary::excess_share()
    double deciding;            ///< trajectories that the share rests on
  };
  bool is_reached = false;  ///< whether the last fit is good enough
  std::vector<stop> stops;  ///< the last is that of the fit

  /// A sentence with the numbers.
  std::string report() const {
    const auto& [trajectories, share, deciding] = stops.back();
    if (is_reached) return fmt::format("{} trajectories are enough", trajectories);
    return fmt::format(
        "{} trajectories are not enough: the uncertainty of the parameters adds {:.2g} of the loss, and "
        "rests on "
        "{:.0f} of them",
        trajectories, share, deciding);
  }
};

/// Learns with M = first, 2 first, ... trajectories until fit_summary::excess_share() is at most the share
/// asked for, or M is the most that may be. The excess falls as 1/M [li_lu_tao_ye_2023, theorem 3.1], so that
/// M ends between enough and twice that. It is an estimate itself, off by a fifth from 50 trajectories: begin
/// with some tens. Where it rests on less than ten of them it does not count. Where it cannot be told, as
/// where the guard holds the parameters, it stops at once. Throws std::invalid_argument unless 0 < share, and
/// 2 <= first <= most. Cost: twice that of the last fit.
inline enough_course until_enough(std::int64_t first, const enough_options& options,
                                  const std::function<fit_summary(std::int64_t trajectories)>& learn) {
  if (!(options.share > 0.0) || first < 2 || first > options.most) {
    throw std::invalid_argument(
        fmt::format("until_enough: a share above 0, and from 2 trajectories on to as many at least; got a "
                    "share of {} and "
                    "{} to {} trajectories",
                    options.share, first, options.most));
  }
  enough_course course;
  for (std::int64_t trajectories = first;; trajectories = std::min(2 * trajectories, options.most)) {
    const fit_summary fit = learn(trajectories);
    const double share = fit.excess_share();
    course.stops.push_back({trajectories, share, fit.deciding_trajectories});
    course.is_reached = share <= options.share && !fit.is_decided_by_few();
    if (course.is_reached || std::isnan(share) || trajectories == options.most) return course;
  }
}

}  // namespace nysalt
