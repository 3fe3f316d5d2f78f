// SPDX-License-Identifier: BSL-1.0
// What is sampled along trajectories, and how far that is.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "nysalt/ensemble_run.hpp"
#include "plans.hpp"

namespace nysalt::program {

/// Samples of a trajectory: values of all observables at steps first, first + every, ...
struct record {
  std::int64_t first = 0;
  std::vector<double> values = {};
  std::optional<std::int64_t> diverged_at = {};  // beyond `first`
};

/// How far a run is: trajectories before `first` are finished; those after it are as they were saved, and if
/// none were, they have not begun.
struct standing {
  std::int64_t first = 0;
  saved_runs wave = {};

  bool is_new() const { return first == 0 && wave.diverged_at.empty(); }
};

/// What is sampled along the trajectories of a plan.
struct sampled_plan {
  trajectories_plan trajectories;
  std::vector<std::string> observables;
  std::int64_t every = 1;
  std::optional<std::int64_t> stretch = {};  // steps after which to hand over what there is; nothing: all
  // Of rank 0 alone:
  standing from = {};
  std::function<void(const standing&)> reached = {};  // told after each stretch, if there are stretches
};

}  // namespace nysalt::program
