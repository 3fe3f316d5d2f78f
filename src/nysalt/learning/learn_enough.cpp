// SPDX-License-Identifier: BSL-1.0
// How many trajectories are enough.

#include "nysalt/learning/learn_enough.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

namespace nysalt {

std::string enough_course::report() const {
  const auto& [trajectories, share, deciding] = stops.back();
  if (is_reached) return fmt::format("{} trajectories are enough", trajectories);
  return fmt::format(
      "{} trajectories are not enough: the uncertainty of the parameters adds {:.2g} of the loss, and "
      "rests on "
      "{:.0f} of them",
      trajectories, share, deciding);
}

enough_course detail::until_enough(std::int64_t first, const enough_options& options,
                                   const std::function<fit_summary(std::int64_t trajectories)>& learn) {
  if (!(options.share > 0.0) || first < 2 || first > options.most) {
    throw std::invalid_argument(
        fmt::format("until_enough: share must be > 0 and trajectories a range from 2 or more, got a "
                    "share of {} and {} to {} trajectories",
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

learned_enough learn_enough(const family& family, const model& system, const initial_states& ensemble,
                            const reference& reference, const growing_data& growing,
                            const fit_options& options) {
  flow_map_data data;
  flow_map_data held_out;
  std::optional<fit> found;
  const auto learn_from = [&](std::int64_t trajectories) {
    data_options wanted = growing.first;
    wanted.trajectories = trajectories;
    detail::extend_data(system, ensemble, reference, wanted, data);
    wanted.seed = growing.held_out_seed;
    detail::extend_data(system, ensemble, reference, wanted, held_out);
    found = learn(family, system, data, held_out, options);
    return found->summary;
  };
  enough_options enough = growing.enough;
  enough.most = std::min(enough.most, detail::most_trajectories(growing.first, size(system)));
  auto course = detail::until_enough(growing.first.trajectories, enough, learn_from);
  return {std::move(*found), std::move(course)};
}

}  // namespace nysalt
