// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <cstddef>

#include "nysalt/flow_map_data.hpp"

namespace nysalt {

/// Makes of data with fewer trajectories, or none, those of the options, which were the same but for their
/// number: only what is new is made. The pairs have the bits of those made at once; of finer finishes there
/// are more. Throws what make_flow_map_data does. Cost: that of the trajectories that are new.
template <SeparableSystem S, Ensemble<S> E, Reference<S> R>
void extend_data(const S& system, const E& ensemble, const R& reference, data_options options,
                 flow_map_data<S::dimension>& data) {
  const auto there = static_cast<std::int64_t>(data.trajectories());
  if (there >= options.trajectories) return;
  if (there == 0) {
    data = make_flow_map_data(system, ensemble, reference, options);
    return;
  }
  options.first += there;
  options.trajectories -= there;
  const auto further = make_flow_map_data(system, ensemble, reference, options);
  const std::size_t pairs = data.pairs();
  const auto append = [](auto& all, const auto& more) { all.insert(all.end(), more.begin(), more.end()); };
  append(data.start, further.start);
  append(data.finish, further.finish);
  append(data.noise, further.noise);
  for (std::size_t m = 1; m < further.first_of.size(); ++m) {
    data.first_of.push_back(pairs + further.first_of[m]);
  }
  for (const auto& [pair, finish] : further.finer) data.finer.emplace_back(pairs + pair, finish);
  if (data.energies && further.energies) {
    data.energies->include(further.energies->low);
    data.energies->include(further.energies->high);
  }
  data.evaluations += further.evaluations;
  data.seconds += further.seconds;
}

}  // namespace nysalt
