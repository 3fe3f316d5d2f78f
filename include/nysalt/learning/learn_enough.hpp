// SPDX-License-Identifier: BSL-1.0
// Learning from more and more trajectories, until the uncertainty of the parameters hardly matters.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "nysalt/learn.hpp"
#include "nysalt/learning/fit_summary.hpp"

namespace nysalt {

/// When to stop.
struct enough_options {
  double share = 0.01;  ///< largest share of the loss that is due to the uncertainty of the parameters
  std::int64_t most = 100'000;  ///< largest number of trajectories
};

/// The steps by which a fit came to its number of trajectories.
struct enough_course {
  /// One fit on the way.
  struct stop {
    std::int64_t trajectories;  ///< number of trajectories of the fit
    double share;               ///< fit_summary::excess_share() of the fit
    double deciding;            ///< trajectories that the share rests on
  };
  bool is_reached = false;  ///< whether the last fit is good enough
  std::vector<stop> stops;  ///< the last belongs to the fit

  /// A sentence with the numbers.
  std::string report() const;
};

namespace detail {

/// Learns with M = first, 2 first, ... trajectories until fit_summary::excess_share() is at most the share
/// asked for, or M is the most that may be. The excess falls as 1/M [li_lu_tao_ye_2023, theorem 3.1], so that
/// M ends between enough and twice that. It is an estimate itself, off by a fifth from 50 trajectories: begin
/// with some tens. Where it rests on less than ten of them it does not count. Where it has no estimate, as
/// where the guard holds the parameters, it stops at once. Throws std::invalid_argument unless 0 < share, and
/// 2 <= first <= most. Cost: twice the cost of the last fit.
enough_course until_enough(std::int64_t first, const enough_options& options,
                           const std::function<fit_summary(std::int64_t trajectories)>& learn);

}  // namespace detail

/// The data of learn_enough(), and how many trajectories they may grow to.
struct growing_data {
  data_options first;               ///< data of the first fit
  std::uint64_t held_out_seed = 2;  ///< seed of the held-out data, as many as those to learn from
  enough_options enough{};          ///< when to stop; at most as many trajectories as fit into memory
};

/// The last fit, and the course of all fits.
struct learned_enough : fit {
  enough_course course;  ///< history of all fits
};

/// learn() with as many trajectories as necessary, see until_enough(): each time data are made for as many
/// more. What comes out is what learn() gives for that number. Throws what these do.
learned_enough learn_enough(const family& family, const model& system, const initial_states& ensemble,
                            const reference& reference, const growing_data& growing,
                            const fit_options& options = {});

}  // namespace nysalt
