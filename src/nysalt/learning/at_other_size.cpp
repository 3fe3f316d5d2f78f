// SPDX-License-Identifier: BSL-1.0
#include "nysalt/learning/at_other_size.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

#include "nysalt/ensembles/typical_and_energetic.hpp"
#include "nysalt/learning/stability_guard.hpp"

namespace nysalt {

namespace {

constexpr std::int64_t fewest_trajectories = 8;
constexpr std::int64_t fewest_steps = 500;
/// States of coordinates, among which those that are one in a thousand are met many times over.
constexpr std::int64_t many_states = 100'000;

struct length {
  std::int64_t trajectories;
  std::int64_t steps;
};

length length_of(const model& system, const run_time_word& word, std::int64_t most_steps) {
  constexpr std::int64_t most_trajectories = 64;
  constexpr std::int64_t parts = 4096;                       // a large system has many in each trajectory
  constexpr std::int64_t coordinates_at_once = 400'000'000;  // some tenths of a second to seconds, in lanes
  constexpr std::int64_t calls = 200'000;                    // of a black box, whose cost is not known
  const std::int64_t n = system.size();
  const std::int64_t evaluations = is_black_box(system) ? calls : coordinates_at_once / n;
  const std::int64_t trajectories = std::clamp(parts / n, fewest_trajectories, most_trajectories);
  const std::int64_t each = trajectories * std::max(1, word.evaluations_per_step);
  return {trajectories, std::min(most_steps, std::max(fewest_steps, evaluations / each))};
}

/// Typical ones, and as many energetic ones where there are some.
phase_points starts_of(const std::vector<phase_point<double, Eigen::Dynamic>>& all, std::int64_t count) {
  const auto typical = std::min(all.size(), plain_starts);
  const auto wanted = std::min(all.size(), static_cast<std::size_t>(count));
  const auto energetic = std::min(all.size() - typical, wanted / 2);
  phase_points result;
  for (std::size_t k = 0; k < std::min(typical, wanted - energetic); ++k) result.push_back(all[k]);
  for (std::size_t k = 0; k < energetic; ++k) result.push_back(all[typical + k]);
  return result;
}

}  // namespace

size_trial try_at_size(const model& system, const tabulated& method, double step,
                       const initial_states& starts, const trial_options& options) {
  const run_time_word word = method.letters();
  const auto [trajectories, steps] = length_of(system, word, options.steps);
  const auto all = typical_and_energetic_starts(system, starts, options.seed, 0, trajectories);
  size_trial result;
  const stability_guard guard(system, all, word, steps, std::min(all.size(), plain_starts));
  const auto objection_of = [&](met which) {
    return guard.objection(word, method.coefficients(), step, which);
  };
  // The trial run shows what occurs rarely, and lasts for a part of a period.
  result.objection = objection_of(met::often);
  if (!result.objection.empty()) return result;
  trial_options some = options;
  some.steps = steps;
  some.watches_growth = guard.parts() != nullptr;
  result.run = trial_run(system, method, step, starts_of(all, trajectories), some);
  if (!result.run.not_run.empty()) {
    result.objection = fmt::format("no trial run was made: {}", result.run.not_run);
  } else if (!result.run.passed()) {
    result.objection = result.run.objection();
  } else if (result.run.kept() * steps * system.size() < many_states) {
    result.objection = objection_of(met::ever);
  }
  return result;
}

}  // namespace nysalt
