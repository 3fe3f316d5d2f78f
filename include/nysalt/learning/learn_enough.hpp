// SPDX-License-Identifier: BSL-1.0
// Learning from more and more trajectories, until the uncertainty of the parameters hardly matters.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
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
  std::vector<stop> stops;  ///< the last is that of the fit

  /// A sentence with the numbers.
  std::string report() const;
};

/// Learns with M = first, 2 first, ... trajectories until fit_summary::excess_share() is at most the share
/// asked for, or M is the most that may be. The excess falls as 1/M [li_lu_tao_ye_2023, theorem 3.1], so that
/// M ends between enough and twice that. It is an estimate itself, off by a fifth from 50 trajectories: begin
/// with some tens. Where it rests on less than ten of them it does not count. Where it has no estimate, as
/// where the guard holds the parameters, it stops at once. Throws std::invalid_argument unless 0 < share, and
/// 2 <= first <= most. Cost: twice that of the last fit.
enough_course until_enough(std::int64_t first, const enough_options& options,
                           const std::function<fit_summary(std::int64_t trajectories)>& learn);

/// A learned method, and the number of trajectories of the fit.
template <Family F>
struct learned_enough {
  tuned_method<F> method;  ///< carries its step and system, and refuses others
  fit_summary summary;     ///< summary of the last fit
  enough_course course;    ///< history of all fits
};

/// learn() with as many trajectories as necessary, see until_enough(): from first.trajectories on, at most as
/// many as fit into memory. Each time data are made for as many more, and the held-out data, of another seed,
/// have as many too. What comes out is what learn() gives for that number. Throws what these do.
template <Family F, SeparableSystem S, Ensemble<S> E, class... Own>
learned_enough<F> learn_enough(const F& family, const S& system, const E& ensemble,
                               const reference& reference, data_options first, std::uint64_t held_out_seed,
                               enough_options enough = {}, const learn_options<F>& options = {},
                               const own_loss<Own>&... own) {
  flow_map_data data;
  flow_map_data held_out;
  const auto grow = [&](flow_map_data& data_set, std::int64_t trajectories, std::uint64_t seed) {
    data_options wanted = first;
    wanted.trajectories = trajectories;
    wanted.seed = seed;
    extend_data(system, ensemble, reference, wanted, data_set);
  };
  enough.most = std::min(enough.most, most_trajectories(first, size(system)));
  std::optional<learned<F>> found;
  const auto learn_with = [&](std::int64_t trajectories) {
    grow(data, trajectories, first.seed);
    grow(held_out, trajectories, held_out_seed);
    found.emplace(learn(family, system, data, held_out, options, own...));
    return found->summary;
  };
  const auto course = until_enough(first.trajectories, enough, learn_with);
  return {found->method, found->summary, course};
}

}  // namespace nysalt
