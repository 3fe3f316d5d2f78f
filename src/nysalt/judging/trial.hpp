// SPDX-License-Identifier: BSL-1.0
// A method at a step, tried on many trajectories.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "accurate_motion.hpp"
#include "nysalt/judgement.hpp"
#include "nysalt/methods/tabulated.hpp"
#include "nysalt/model.hpp"

namespace nysalt::detail {

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

/// Runs a method in blocks of trajectories. Stops after one in which most of all are lost, and after two if
/// these are clear: of the share lost more is not known then than that it is small.
/// The kinetic energy of the motion is the scale of energies; unless energies are watched only divergence
/// counts.
std::vector<course> run_trial(const model& system, const tabulated& method, double step, const states& starts,
                              const trial_plan& plan, const accurate_motion& motion, bool watches,
                              const judging_options& options, unconfined_starts& unconfined);

}  // namespace nysalt::detail
