// SPDX-License-Identifier: BSL-1.0
// trajectory, the state's error at several times of whole trajectories.
#include <algorithm>
#include <cmath>
#include <utility>

#include "data_loss.hpp"

namespace nysalt::detail {

namespace {

/// Of the first stages, which find where minima lie and should cost little: two windows a trajectory.
after_steps_options at_first(std::vector<int> steps, int shortest) {
  const int apart = std::max(steps.back(), shortest / 2);
  return {.steps = std::move(steps), .apart = apart};
}

/// A step does not see the phase that errors add up to, and the end of a long trajectory sees it only
/// up to whole turns: so times grow from stage to stage, and all times of a stage count.
std::vector<after_steps_options> stages_of_trajectory(int, int shortest) {
  constexpr int times = 16;
  after_steps_options last;
  last.steps.clear();
  for (int k = 1; k <= times; ++k) {
    const int steps = std::max(1, static_cast<int>(std::lround(static_cast<double>(k) * shortest / times)));
    if (last.steps.empty() || last.steps.back() < steps) last.steps.push_back(steps);
  }
  last.apart = shortest;
  std::vector<after_steps_options> result;
  for (const auto& first : {std::vector{1, 2, 4}, std::vector{1, 4, 9, 16}}) {
    if (first.back() < shortest) result.push_back(at_first(first, shortest));
  }
  result.push_back(std::move(last));
  return result;
}

}  // namespace

constinit const loss_kind trajectory_loss{.name = "trajectory",
                                          .counts_steps = false,
                                          .judge = judge_of_minima::training_loss,
                                          .is_of_energy_norm = true,
                                          .is_shortened = true,
                                          .stages = stages_of_trajectory,
                                          .over_data = of_states};

}  // namespace nysalt::detail
