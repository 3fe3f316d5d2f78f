// SPDX-License-Identifier: BSL-1.0
#include "nysalt/analysis/trajectory_errors_result.hpp"

#include <cstddef>
#include <vector>

namespace nysalt {

detail::measured_trajectories::measured_trajectories(std::size_t methods, std::size_t trajectories,
                                                     std::size_t checked, bool null, std::size_t perturbed)
    : runs(methods, std::vector<run_score>(trajectories)),
      checks(checked),
      null_model(null ? trajectories : 0),
      predictable_until(perturbed),
      sizes(trajectories),
      signs(trajectories) {}

void detail::measured_trajectories::gather(const shard& its) {
  for (auto& of_method : runs) its.gather(of_method);
  if (!null_model.empty()) its.gather(null_model);
  its.gather(sizes);
  its.gather(signs);
  broadcast(its.ranks(), checks);
  broadcast(its.ranks(), predictable_until);
}

}  // namespace nysalt
