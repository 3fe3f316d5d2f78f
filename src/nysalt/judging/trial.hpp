// SPDX-License-Identifier: BSL-1.0
// The trial of a method at a step: accurate motion for scales, and what is lost.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "nysalt/judgement.hpp"
#include "nysalt/method.hpp"
#include "nysalt/model.hpp"
#include "nysalt/phase_point.hpp"

namespace nysalt::detail {

using states = std::vector<phase_point<double, Eigen::Dynamic>>;

/// Median of some numbers, which are put into another order; 0 of none.
double median_of(std::vector<double>& numbers);

/// f(T()) with T a pack if there are enough trajectories for its lanes and a pack of states fits into the
/// cache; else with T double.
decltype(auto) in_lanes_if_filled(const model& system, std::int64_t trajectories, const auto& f) {
  constexpr Eigen::Index large = 20'000;
  if (trajectories < pack<double>::lanes / 4 || size(system) > large) return f(double());
  return with_scalar_of(system, f);
}

/// What an accurate motion shows.
struct accurate_motion {
  double kinetic_energy = 0.0;  // median over trajectories and times; 0: not known, as where it still rises
  states seen;                  // states along it, typical ones first
  double step = 0.0;            // the coarsest that was tried at which the energy stays
  bool is_followed = true;      // false: at none it does
};

/// Finest step of the accurate motion, in steps of the trial.
constexpr double finest_step = 1.0 / 512.0;

/// Of the system without a bath, as long as the trial or shorter: at the coarsest of some steps at which the
/// energy stays. Cost: some 10^5 evaluations for each step that is tried, nine at most.
accurate_motion follow(const model& system, const states& starts, double step, std::int64_t evaluations,
                       const judging_options& options);

// A method at a step, tried on many trajectories.

/// A run four times as long as the trial is what a verdict is for.
constexpr double longer = 4.0;
/// An energy error that grows in proportion to time exceeds the kinetic energy within `longer` trials from
/// this share of it on.
constexpr double large_error = 1.0 / longer;
constexpr std::int64_t windows = 16;

/// How many trajectories of how many steps a trial takes, and what the accurate motion before it.
struct trial_plan {
  std::int64_t trajectories = 0;
  std::int64_t steps = 0;
};

/// Of `evaluations` in all: from the first 512 starts if each is followed for some thousand steps, else from
/// fewer, and then over fewer steps: eight trajectories of 500, and where that is too much fewer
/// trajectories, as a system so large has many parts in each.
trial_plan plan_of(std::int64_t evaluations, int of_step, std::int64_t starts, std::int64_t most_steps);

/// A trajectory of a trial.
struct course {
  double initial = 0.0;
  std::array<double, windows> sum{};      // of |H - H_0|
  std::array<double, windows> largest{};  // |H - H_0|
  std::array<double, windows> reads{};
  std::vector<double> last;  // |H - H_0| in the last window
  double largest_of_all = 0.0;
  double magnitude = 0.0;      // of H
  std::int64_t at = 0;         // of the largest
  std::int64_t large_at = -1;  // first read above the kinetic energy
  std::optional<std::int64_t> diverged_at;
  bool is_left_out = false;
};

/// Which starts an accurate method loses too within a number of steps, as far as they were tried: not a
/// matter of the method that is judged.
using unconfined_starts = std::map<std::pair<std::size_t, std::int64_t>, bool>;

/// What a trial is made on.
struct trial_setting {
  const model& system;
  const states& starts;
  double step;
  trial_plan plan;
  const accurate_motion& motion;  ///< its kinetic energy is the scale of energies
  bool watches;                   ///< whether energies are watched; else only divergence counts
  const judging_options& options;
};

/// Runs a method in blocks of trajectories. Stops after one in which most of all are lost, and after two if
/// these are clear: of the share lost more is not known then than that it is small.
std::vector<course> run_trial(const trial_setting& setting, const method& method,
                              unconfined_starts& unconfined);

}  // namespace nysalt::detail
