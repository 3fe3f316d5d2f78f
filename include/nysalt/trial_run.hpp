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

#include "nysalt/bath.hpp"
#include "nysalt/divergence.hpp"
#include "nysalt/ensembles/listed.hpp"
#include "nysalt/integrate_ensemble.hpp"
#include "nysalt/methods/blanes_moan.hpp"
#include "nysalt/methods/frequency_to_fit.hpp"
#include "nysalt/methods/tabulated.hpp"
#include "nysalt/noises/counter_noise.hpp"

namespace nysalt {

/// How long a trial lasts.
struct trial_options {
  std::int64_t steps = 20'000;  ///< of each trajectory
  std::uint64_t seed = 1;       ///< of the noise, in a bath
  int threads = 1;              ///< changes no bit
};

/// Result of a trial run: whether a trajectory diverged, and how far the energies went.
struct trial_result {
  std::int64_t trajectories = 0;            ///< that were run; fewer than the starts after a divergence
  std::int64_t steps = 0;                   ///< of each
  std::int64_t diverged = 0;                ///< number of trajectories that diverged
  std::optional<diverged_trajectory> lost;  ///< the one of the lowest number that diverged
  bool energy_was_watched = false;          ///< false: in a bath, or H is not known
  double first_deviation = 0.0;  ///< largest |H - H_0| of all trajectories in the first stretch, steps/10
  double deviation = 0.0;        ///< the same over all steps
  double rounding = 0.0;         ///< bound of what rounding adds to |H - H_0|
  double kinetic_energy = 0.0;   ///< mean over trajectories and time
  double relative_deviation =
      0.0;                      ///< largest over trajectories of |H - H_0|/(the largest K of the trajectory)
  std::int64_t unconfined = 0;  ///< trajectories left out, as an accurate method loses them as well
  diverged_trajectory farthest{};  ///< where `deviation` was met
  std::string not_run{};           ///< why no trial was run; else empty

  /// Ten times as many samples of a stationary deviation with a finite variance, or a random walk ten times
  /// as long, have a maximum larger by sqrt(10); a larger one means that the energy drifts.
  static constexpr double stretches = 10.0;

  /// Of fewer steps the first stretch may be shorter than a period of slow motion, some hundred steps.
  static constexpr std::int64_t fewest_steps_for_drift = 5'000;
  /// Of the mean kinetic energy: a drift that changes a temperature by less is not seen in what runs measure.
  static constexpr double smallest_drift = 0.05;

  /// Whether the energy went farther than the first stretch explains.
  bool energy_wanders() const {
    return energy_was_watched && deviation > smallest_drift * kinetic_energy &&
           steps >= fewest_steps_for_drift && deviation > std::sqrt(stretches) * first_deviation + rounding;
  }
  /// Trajectories that count.
  std::int64_t kept() const { return trajectories - unconfined; }
  /// Whether the trial was run, no trajectory diverged and the energy did not drift.
  bool passed() const { return not_run.empty() && !lost && !energy_wanders(); }

  /// One sentence on why it failed; empty if it passed or was not run.
  std::string objection() const;

  /// What was tried and what came of it, in one line.
  std::string report() const;
};

/// Starts of a trial: in a bath each is taken again, with noise of its own, until they are as many as where
/// energetic starts are known too.
template <SeparableSystem S>
std::vector<phase_point<double, S::dimension>> repeated_in_bath(
    const S& system, std::vector<phase_point<double, S::dimension>> starts) {
  if constexpr (HasBath<S>) {
    constexpr std::size_t enough = 192;
    const std::size_t given = starts.size();
    for (std::size_t k = 0; system.bath().acts() && given > 0 && starts.size() < enough; ++k) {
      starts.push_back(starts[k % given]);
    }
  }
  return starts;
}

/// Runs a method from each start, in lanes and on threads, and looks at H every few steps; in a bath with its
/// noise, and without looking at H. Trajectories are run in blocks; after a block in which one diverged it
/// stops. Neither lanes nor threads change a bit. Throws std::invalid_argument if the method does not suit
/// the system, there are no starts or steps, or a start is not finite. Cost: starts * steps steps.
/// Trajectories that diverge under an accurate method too, S6 [blanes_moan_2002] in parts of a step, are
/// left out: their motion is not confined. If all are, the trial counts as not run.
template <SeparableSystem S>
trial_result trial_run(const S& system, const tabulated& method, double step,
                       const std::vector<phase_point<double, S::dimension>>& starts,
                       const trial_options& options = {}) {
  using T = scalar_of_lanes<lanes_of<S>>;
  constexpr std::int64_t block = 64;
  // Every seventh step: no low-order resonance has this period.
  constexpr std::int64_t every = 7;
  trial_result result;
  result.steps = options.steps;
  if constexpr (HasEnergy<S>) result.energy_was_watched = true;
  if constexpr (HasBath<S>) result.energy_was_watched &= !system.bath().acts();

  const listed<S::dimension> all(starts);
  const auto first_stretch = static_cast<double>(options.steps) / trial_result::stretches;
  struct deviations {
    double initial = 0.0;
    double first = 0.0;
    double largest = 0.0;
    double magnitude = 0.0;
    std::int64_t at = 0;
    double kinetic = 0.0;  // sum over looks
    double peak = 0.0;     // of the kinetic energy
    double looks = 0.0;
    bool is_left_out = false;
  };
  std::vector<deviations> of_trajectory(starts.size());
  const auto read = [&](const phase_point<T, S::dimension>& x, std::span<T> numbers) {
    if constexpr (HasEnergy<S>) {
      if (!result.energy_was_watched) return;
      auto at_rest = x;
      for (T& p : at_rest.p) p = T(0.0);
      numbers[0] = energy_in_lanes<T>(system, x);
      numbers[1] = numbers[0] - energy_in_lanes<T>(system, at_rest);
    }
  };
  const auto take = [&](std::int64_t m, std::int64_t n, std::span<const double> numbers) {
    if (!result.energy_was_watched) return;
    auto& known = of_trajectory[static_cast<std::size_t>(m)];
    if (n == 0) known.initial = numbers[0];
    double departure = std::abs(numbers[0] - known.initial);
    if (std::isnan(departure)) departure = std::numeric_limits<double>::infinity();
    known.magnitude = std::max(known.magnitude, std::abs(numbers[0]));
    known.kinetic += numbers[1];
    known.peak = std::max(known.peak, numbers[1]);
    known.looks += 1.0;
    if (static_cast<double>(n) <= first_stretch) known.first = std::max(known.first, departure);
    if (departure <= known.largest) return;
    known.largest = departure;
    known.at = n;
  };
  const auto stepper_of = [&](const tabulated& one, double h) {
    if constexpr (HasBath<S>) {
      return make_stepper(system, one, h, counter_noise(options.seed));
    } else {
      return make_stepper(system, one, h);
    }
  };
  // Parts of a step that an accurate method takes: of the highest frequency that is declared less than a
  // radian each, far inside its window. Where that is too many, nothing is known of what is lost.
  constexpr double most_parts = 64.0;
  const auto parts_of_step = [&] {
    double highest = 0.0;
    if constexpr (HasFrequencyBands<S>) {
      for (const auto& band : system.frequency_bands()) highest = std::max(highest, band.high);
    } else if constexpr (HasModes<S>) {
      highest = detail::frequency_to_fit(system);
    }
    return std::max(8.0, std::ceil(std::abs(step) * highest));
  };
  // Whether an accurate method loses a trajectory too: at a fine step and, so that it is not its own
  // instability, at a finer one.
  const auto is_unconfined = [&](const std::vector<diverged_trajectory>& some, int parts) {
    std::vector<phase_point<double, S::dimension>> at;
    for (const auto& one : some) at.push_back(starts[static_cast<std::size_t>(one.trajectory)]);
    std::vector<bool> result(some.size(), true);
    for (const int finer : {parts, 4 * parts}) {
      const auto accurate = stepper_of(tabulated(blanes_moan_s6{}), step / finer);
      const auto diverged_at = integrate_ensemble<T>(
          accurate, listed<S::dimension>(at),
          {.trajectories = std::ssize(at),
           .steps = finer * options.steps,
           .every = finer * options.steps,
           .threads = options.threads},
          2, [](const auto&, std::span<T>) {}, [](auto&&...) {});
      for (std::size_t k = 0; k < some.size(); ++k) result[k] = result[k] && diverged_at[k].has_value();
      if (std::ranges::none_of(result, std::identity{})) break;
    }
    return result;
  };
  // A few at a time: the first that the motion does not lose decides.
  const auto leave_out_unconfined = [&](const std::vector<diverged_trajectory>& lost) {
    const double parts = parts_of_step();
    if (!(parts <= most_parts)) return;
    if constexpr (HasBath<S>) {
      if (system.bath().acts()) return;
    }
    constexpr std::size_t few = 8;
    for (std::size_t begin = 0; begin < lost.size(); begin += few) {
      const std::size_t end = std::min(begin + few, lost.size());
      const std::vector<diverged_trajectory> some(lost.begin() + static_cast<std::ptrdiff_t>(begin),
                                                  lost.begin() + static_cast<std::ptrdiff_t>(end));
      const auto unconfined = is_unconfined(some, static_cast<int>(parts));
      for (std::size_t k = 0; k < some.size(); ++k) {
        if (!unconfined[k]) continue;
        of_trajectory[static_cast<std::size_t>(some[k].trajectory)].is_left_out = true;
        ++result.unconfined;
      }
      if (!std::ranges::all_of(unconfined, std::identity{})) return;
    }
  };
  const auto stepper = stepper_of(method, step);
  for (std::int64_t first = 0; first < std::ssize(starts) && !result.lost; first += block) {
    const std::int64_t count = std::min(block, std::ssize(starts) - first);
    const auto diverged_at =
        integrate_ensemble<T>(stepper, all,
                              {.trajectories = count,
                               .steps = options.steps,
                               .every = result.energy_was_watched ? every : options.steps,
                               .seed = options.seed,
                               .threads = options.threads,
                               .first = first},
                              2, read, take);
    result.trajectories += count;
    std::vector<diverged_trajectory> lost;
    for (std::size_t k = 0; k < diverged_at.size(); ++k) {
      if (diverged_at[k]) lost.push_back({first + static_cast<std::int64_t>(k), *diverged_at[k]});
    }
    if (lost.empty()) continue;
    leave_out_unconfined(lost);
    for (const auto& one : lost) {
      if (of_trajectory[static_cast<std::size_t>(one.trajectory)].is_left_out) continue;
      ++result.diverged;
      if (!result.lost) result.lost = one;
    }
  }

  double magnitude = 0.0;
  double kinetic = 0.0;
  double looks = 0.0;
  for (std::size_t m = 0; m < of_trajectory.size(); ++m) {
    const auto& known = of_trajectory[m];
    if (known.is_left_out) continue;
    kinetic += known.kinetic;
    looks += known.looks;
    magnitude = std::max(magnitude, known.magnitude);
    result.first_deviation = std::max(result.first_deviation, known.first);
    if (known.largest > 0.0) {
      result.relative_deviation = std::max(result.relative_deviation, known.largest / known.peak);
    }
    if (known.largest <= result.deviation) continue;
    result.deviation = known.largest;
    result.farthest = {static_cast<std::int64_t>(m), known.at};
  }
  if (looks > 0.0) result.kinetic_energy = kinetic / looks;
  if (result.unconfined > 0 && result.kept() == 0) {
    result.not_run = "an accurate method loses every start too: the motion is not confined";
  }
  // Each letter rounds H once at most, in one direction at worst.
  result.rounding = static_cast<double>(options.steps) * static_cast<double>(method.letters().length) *
                    std::numeric_limits<double>::epsilon() * magnitude;
  return result;
}

}  // namespace nysalt
