// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>

#include "nysalt/flow_map_data.hpp"
#include "nysalt/learning/hand_over.hpp"

namespace nysalt {

namespace detail {
/// The pairs of further trajectories behind those that there are.
template <int N>
void append(flow_map_data<N>& data, const flow_map_data<N>& further) {
  const std::size_t pairs = data.pairs();
  const auto add = [](auto& all, const auto& more) { all.insert(all.end(), more.begin(), more.end()); };
  add(data.start, further.start);
  add(data.finish, further.finish);
  add(data.noise, further.noise);
  for (std::size_t m = 1; m < further.first_of.size(); ++m) {
    data.first_of.push_back(pairs + further.first_of[m]);
  }
  for (const auto& [pair, finish] : further.finer) data.finer.emplace_back(pairs + pair, finish);
}
}  // namespace detail

/// Makes of data with fewer trajectories, or none, those of the options, which were the same but for their
/// number: only what is new is made. The pairs have the bits of those made at once; of finer finishes there
/// are more. Ranks hand over trajectories that become another's. Throws what make_flow_map_data does. Cost:
/// that of the trajectories that are new.
template <SeparableSystem S, Ensemble<S> E, Reference<S> R>
void extend_data(const S& system, const E& ensemble, const R& reference, data_options options,
                 flow_map_data<S::dimension>& data) {
  const std::int64_t there = data.share().total();
  if (there >= options.trajectories) return;
  if (there == 0) {
    data = make_flow_map_data(system, ensemble, reference, options);
    return;
  }
  const auto began = std::chrono::steady_clock::now();
  const std::int64_t steps = detail::steps_of_each(options, size(system));
  const shard all(options.trajectories, *options.ranks);
  detail::hand_over(data, all, size(system));

  data_options of_further = options;
  of_further.first += there;
  of_further.trajectories -= there;
  const std::int64_t end = all.first() + all.count();
  const std::int64_t begin = std::clamp(there, all.first(), end);
  flow_map_data<S::dimension> further;
  together(all.ranks(), [&] {
    further =
        detail::make_some_pairs(system, ensemble, reference, of_further, all, begin - there, end - begin);
  });
  detail::add_up(further);
  detail::append(data, further);
  if (data.energies && further.energies) {
    data.energies->include(further.energies->low);
    data.energies->include(further.energies->high);
  }
  data.further_starts = typical_and_energetic_starts(
      system, ensemble, options.seed, options.first + options.trajectories, options.trajectories);
  data.evaluations += further.evaluations;
  data.shared.reset();
  if (!all.ranks().is_alone()) {
    data.shared = shared_pairs{all, static_cast<std::size_t>(all.first() * steps),
                               static_cast<std::size_t>(all.total() * steps)};
  }
  data.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
}

}  // namespace nysalt
