// SPDX-License-Identifier: BSL-1.0
// Plans for a problem: trajectories, and what is learned, gathered or measured along them.
#pragma once

#include <any>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "asked_metric.hpp"
#include "nysalt/analysis/statistics.hpp"
#include "nysalt/langevin.hpp"
#include "nysalt/learning/learn_enough.hpp"
#include "nysalt/method.hpp"
#include "settings.hpp"

namespace nysalt::program {

/// Called with how much is done; what it throws ends the work.
using counter = std::function<void(std::int64_t)>;

/// Trajectories from the system's starts: `count` of them, `steps` steps each.
struct trajectories_plan {
  double step;
  std::int64_t steps;
  std::int64_t count;
  std::uint64_t seed;
  int threads;
  std::optional<double> horizon = {};  // within the last step: errors are means up to there
};

struct learn_plan {
  std::string family;
  std::optional<placement> where;  // of the letters O, in a bath
  double step;
  learning_options how;
  std::uint64_t seed;
  std::uint64_t held_out_seed;
  int threads;
  std::vector<double> from = {};       // the optimum at a step nearby: one more start
  bool only_from_there = false;        // and no other
  std::vector<double> contained = {};  // the optimum of the family that this one contains; empty: not known
  bool goes_on = false;                // another search begins where this one ends
  std::optional<enough_options> enough = {};  // as many trajectories as it takes, from those of `how` on
  // Where what is made for few trajectories is kept for the same plan with more; nothing: nowhere.
  std::shared_ptr<std::any> kept = {};
};

struct learned_scheme {
  fit_summary fit;
  nysalt::method method;                 // with its letters O
  std::optional<energy_range> energies;  // of the training data
  std::optional<enough_course> course = {};
};

/// Trajectories and the statistics that are gathered along them.
struct statistics_plan {
  trajectories_plan trajectories;
  std::int64_t every = 1;  // steps between samples
  std::int64_t first = 0;  // number of the first trajectory
  std::optional<equal_bins> bins = {};
  std::optional<int> lags = {};
  int finer = 1;  // factor by which the fine step of the reference is divided
};

/// Errors along the trajectories of a plan.
struct errors_plan {
  trajectories_plan trajectories;
  std::vector<asked_metric> metrics;
  std::optional<double> fine_step = {};  // of the reference; nothing: the usual
  bool null_model = false;
  std::optional<double> perturbation = {};  // of the starts, to see how far they can be followed
};

}  // namespace nysalt::program
