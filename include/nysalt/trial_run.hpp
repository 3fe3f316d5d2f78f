// SPDX-License-Identifier: BSL-1.0
// A method run for long from many starts: what no linear criterion sees.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "nysalt/detail/divergence.hpp"
#include "nysalt/methods/tabulated.hpp"
#include "nysalt/model.hpp"
#include "nysalt/phase_points.hpp"

namespace nysalt {

/// Length of a trial.
struct trial_options {
  std::int64_t steps = 20'000;  ///< steps of each trajectory
  std::uint64_t seed = 1;       ///< seed of the noise, in a bath
  int threads = 1;              ///< changes no bit
  /// Whether the energy errors of all steps are compared with those of the first early_steps too. For words
  /// with kicks of parts of V, whose errors of an early step show all that a stable motion has.
  bool watches_growth = false;
};

/// Result of a trial run: whether a trajectory diverged, and how far the energies went.
struct trial_result {
  std::int64_t trajectories = 0;  ///< trajectories that were run; fewer than the starts after a divergence
  std::int64_t steps = 0;         ///< steps of each trajectory
  std::int64_t diverged = 0;      ///< number of trajectories that diverged
  std::optional<diverged_trajectory> lost;  ///< diverged trajectory with the lowest number
  bool energy_was_watched = false;          ///< false: in a bath, or H is not known
  double first_deviation = 0.0;  ///< largest |H - H_0| of all trajectories in the first tenth of the steps
  double deviation = 0.0;        ///< largest energy deviation over all steps
  double early_deviation =
      0.0;  ///< largest energy deviation over the first early_steps; 0 if growth was not watched
  bool growth_was_watched = false;  ///< early_deviation is known
  double rounding = 0.0;            ///< bound of what rounding adds to |H - H_0|
  double kinetic_energy = 0.0;      ///< mean over trajectories and time
  double relative_deviation =
      0.0;                      ///< largest over trajectories of |H - H_0|/(the largest K of the trajectory)
  std::int64_t unconfined = 0;  ///< number of trajectories left out, which diverge by an accurate method, too
  diverged_trajectory farthest{};  ///< trajectory with the largest deviation
  std::string not_run{};           ///< why no trial was run; else empty

  /// Ten times as many samples of a stationary deviation with a finite variance, or a random walk ten times
  /// as long, have a maximum larger by sqrt(10); a larger one means that the energy drifts.
  static constexpr double intervals = 10.0;

  /// Smallest number of steps of a test for drift: of fewer, the first tenth may be shorter than a period of
  /// slow motion, some hundred steps.
  static constexpr std::int64_t fewest_steps_for_drift = 5'000;
  /// Smallest relevant drift, as a share of the mean kinetic energy: less does not show in a temperature.
  static constexpr double smallest_drift = 0.05;

  /// Whether the energy went farther than the first tenth explains.
  bool energy_wanders() const {
    return energy_was_watched && deviation > smallest_drift * kinetic_energy &&
           steps >= fewest_steps_for_drift && deviation > std::sqrt(intervals) * first_deviation + rounding;
  }
  /// Some periods of fast modes and, at the steps of slow kicks, one of slow ones.
  static constexpr std::int64_t early_steps = 64;
  /// A stable motion that is examined in every one of these shows its largest error to less than this factor.
  static constexpr double largest_growth = 3.0;

  /// Whether the energy went farther than early steps explain, as near a resonance of slow kicks.
  bool energy_grows() const {
    return growth_was_watched && energy_was_watched && steps >= fewest_steps_for_drift &&
           deviation > smallest_drift * kinetic_energy &&
           deviation > largest_growth * early_deviation + rounding;
  }
  /// Trajectories that count.
  std::int64_t kept() const { return trajectories - unconfined; }
  /// Whether the trial was run, no trajectory diverged and the energy did not drift.
  bool passed() const { return not_run.empty() && !lost && !energy_wanders() && !energy_grows(); }

  /// Reason of the failure, one sentence; empty if the trial run passed or was not run.
  std::string objection() const;

  /// The trial and its result, in one line.
  std::string report() const;
};

/// Starts of a trial: in a bath each is taken again, with noise of its own, until they are as many as where
/// energetic starts are known too.
phase_points repeated_in_bath(const model& system, phase_points starts);

/// Runs a method from each start, in lanes and on threads, and reads H every few steps; in a bath with its
/// noise, and without reading H. Trajectories are run in blocks; after a block in which one diverged it
/// stops. Neither lanes nor threads change a bit. Throws std::invalid_argument if the method does not suit
/// the system, there are no starts or steps, or a start is not finite. Cost: starts * steps steps.
/// Trajectories that diverge under an accurate method too, S6 [blanes_moan_2002] in parts of a step, are
/// left out: their motion is not confined. If all are, the trial counts as not run.
trial_result trial_run(const model& system, const tabulated& method, double step, const phase_points& starts,
                       const trial_options& options = {});

}  // namespace nysalt
