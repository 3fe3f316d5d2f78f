// SPDX-License-Identifier: BSL-1.0
#include "length_of_trial.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace nysalt::detail {

trial_length length_of_trial(const learning_problem& problem) {
  constexpr std::int64_t most = 256;
  const std::int64_t few = problem.trial_trajectories;
  constexpr std::int64_t fewest = 8;
  constexpr std::int64_t long_enough = 10'000;
  constexpr std::int64_t shortest = 100;
  const std::int64_t each = std::max(1, problem.family.letters.evaluations_per_step);
  const std::int64_t cheap = std::min(problem.trial_evaluations, few * problem.options.planned_steps * each);
  const std::int64_t budget = std::max(problem.evaluations() / 2, cheap);
  trial_length result{std::min(most, problem.trial_starts), problem.options.planned_steps};
  const std::int64_t steps_in_all = budget / each;
  const auto fewer_trajectories = [&](std::int64_t least) {
    result.trajectories = std::min(result.trajectories, std::max(least, steps_in_all / result.steps));
  };
  fewer_trajectories(few);
  result.steps = std::clamp(steps_in_all / std::max<std::int64_t>(1, result.trajectories),
                            std::min(long_enough, result.steps), result.steps);
  fewer_trajectories(fewest);
  result.steps = std::min(result.steps, steps_in_all / std::max<std::int64_t>(1, result.trajectories));
  if (result.trajectories < 1 || result.steps < std::min(shortest, problem.options.planned_steps)) {
    result.not_run =
        fmt::format("learning took {} force evaluations, fewer than {} trajectories of {} steps would take",
                    budget, std::max<std::int64_t>(1, result.trajectories), shortest);
  }
  return result;
}

}  // namespace nysalt::detail
