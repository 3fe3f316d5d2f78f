// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <algorithm>
#include <optional>

#include "nysalt/learn.hpp"
#include "nysalt/learning/until_enough.hpp"

namespace nysalt {

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
template <Family F, SeparableSystem S, Ensemble<S> E, Reference<S> R, class... Own>
learned_enough<F> learn_enough(const F& family, const S& system, const E& ensemble, const R& reference,
                               data_options first, std::uint64_t held_out_seed, enough_options enough = {},
                               const learn_options<F>& options = {}, const own_loss<Own>&... own) {
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
