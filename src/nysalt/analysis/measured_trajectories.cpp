// SPDX-License-Identifier: BSL-1.0
#include "measured_trajectories.hpp"

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <vector>

namespace nysalt::detail {

measured_trajectories::measured_trajectories(std::size_t methods, std::size_t trajectories,
                                             std::size_t checked, bool null, std::size_t perturbed)
    : runs(methods, std::vector<run_score>(trajectories)),
      checks(checked),
      null_model(null ? trajectories : 0),
      predictable_until(perturbed),
      sizes(trajectories),
      signs(trajectories) {}

void measured_trajectories::gather(const shard& own) {
  for (auto& of_method : runs) own.gather(of_method);
  if (!null_model.empty()) own.gather(null_model);
  own.gather(sizes);
  own.gather(signs);
  broadcast(own.ranks(), checks);
  broadcast(own.ranks(), predictable_until);
}

trajectory_errors_result measured_trajectories::summary(const error_measure& measure,
                                                        const std::string& reference) const {
  const bool is_nothing = measure.relative_to && !(measure.unit(sizes) > 0.0);
  const auto differs = [&](double sign) { return sign != signs.front(); };
  if (is_nothing || std::ranges::any_of(signs, differs)) throw std::invalid_argument(measure.no_scale);
  trajectory_errors_result result;
  for (const auto& of_method : runs) result.methods.push_back(error_of_runs(of_method, measure, sizes));
  result.unit = measure.unit(sizes);
  if (!measure.needs_reference) return result;
  result.reference_error = measure.average(checks, sizes);
  result.reference = reference;
  if (!null_model.empty()) result.null_model = measure.average(null_model, sizes);
  if (!predictable_until.empty()) result.predictable_until = median(predictable_until);
  return result;
}

}  // namespace nysalt::detail
