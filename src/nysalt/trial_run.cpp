// SPDX-License-Identifier: BSL-1.0
#include "nysalt/trial_run.hpp"

#include <algorithm>
#include <functional>
#include <limits>
#include <span>

#include "nysalt/ensembles/listed.hpp"
#include "nysalt/integrate_ensemble.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/methods/frequency_to_fit.hpp"
#include "nysalt/noises/counter_noise.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <string>

namespace nysalt {

std::string trial_result::objection() const {
  if (lost) {
    return fmt::format("in a trial run of {} steps, {} of {} trajectories diverge, trajectory {} at step {}",
                       steps, diverged, trajectories, lost->trajectory, lost->step);
  }
  if (energy_wanders()) {
    return fmt::format(
        "in a trial run of {} steps the energy of trajectory {} departs by {:.2g} at step {}, which is "
        "{:.2g} times the largest deviation of all trajectories in the first {} steps",
        steps, farthest.trajectory, deviation, farthest.step, deviation / first_deviation,
        static_cast<std::int64_t>(static_cast<double>(steps) / intervals));
  }
  if (energy_grows()) {
    return fmt::format(
        "in a trial run of {} steps the energy of trajectory {} departs by {:.2g} at step {}, which is "
        "{:.2g} times the largest deviation of all trajectories in the first {} steps",
        steps, farthest.trajectory, deviation, farthest.step, deviation / early_deviation, early_steps);
  }
  return {};
}

std::string trial_result::report() const {
  if (!not_run.empty()) return "not run: " + not_run;
  const std::string length = fmt::format("{} trajectories of {} steps", trajectories, steps);
  if (lost) return fmt::format("{}: {} diverged, the first at step {}", length, diverged, lost->step);
  const std::string left_out =
      unconfined == 0 ? "" : fmt::format(", {} left out whose motion is not confined", unconfined);
  if (!energy_was_watched) return length + left_out + ": none diverged";
  return fmt::format("{}{}: none diverged, |H - H_0| up to {:.2e}, up to {:.2e} in the first tenth{}", length,
                     left_out, deviation, first_deviation,
                     energy_wanders() ? ": the energy drifts"
                     : energy_grows() ? ": the energy error grows"
                                      : "");
}

namespace {

using states = std::vector<phase_point<double, Eigen::Dynamic>>;

/// As many trajectories at a time as T has lanes.
template <class T>
trial_result run_in_lanes(const model& system, const tabulated& method, double step, const states& starts,
                          const trial_options& options) {
  constexpr std::int64_t block = 64;
  // Every seventh step: no low-order resonance has this period.
  constexpr std::int64_t every = 7;
  trial_result result;
  result.steps = options.steps;
  result.energy_was_watched = has_energy(system) && !system.bath().acts();

  const listed<Eigen::Dynamic> all(starts);
  const auto first_interval = static_cast<double>(options.steps) / trial_result::intervals;
  struct deviations {
    double initial = 0.0;
    double first = 0.0;
    double largest = 0.0;
    double magnitude = 0.0;
    std::int64_t at = 0;
    double kinetic = 0.0;  // sum over observations
    double peak = 0.0;     // of the kinetic energy
    double observations = 0.0;
    bool is_left_out = false;
  };
  std::vector<deviations> of_trajectory(starts.size());
  const auto read = [&](const phase_point<T, Eigen::Dynamic>& x, std::span<T> numbers) {
    if (!result.energy_was_watched) return;
    auto at_rest = x;
    for (T& p : at_rest.p) p = T(0.0);
    numbers[0] = energy<T>(system, x);
    numbers[1] = numbers[0] - energy<T>(system, at_rest);
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
    known.observations += 1.0;
    if (static_cast<double>(n) <= first_interval) known.first = std::max(known.first, departure);
    if (departure <= known.largest) return;
    known.largest = departure;
    known.at = n;
  };
  const auto stepper_of = [&](const tabulated& one, double h) {
    return make_stepper(system, one, h, counter_noise(options.seed));
  };
  // Parts of a step that an accurate method takes: of the highest frequency that is declared less than a
  // radian each, far inside its window. Where that is too many, nothing is known of what is lost.
  constexpr double most_parts = 64.0;
  const auto parts_of_step = [&] {
    double highest = 0.0;
    if (has_frequency_bands(system)) {
      for (const auto& band : system.frequency_bands()) highest = std::max(highest, band.high);
    } else if (has_modes(system)) {
      highest = detail::frequency_to_fit(system);
    }
    return std::max(8.0, std::ceil(std::abs(step) * highest));
  };
  // Whether an accurate method loses a trajectory too: at a fine step and, so that it is not its own
  // instability, at a finer one.
  const auto is_unconfined = [&](const std::vector<diverged_trajectory>& some, int parts) {
    states at;
    for (const auto& one : some) at.push_back(starts[static_cast<std::size_t>(one.trajectory)]);
    std::vector<bool> result(some.size(), true);
    for (const int finer : {parts, 4 * parts}) {
      const auto accurate = stepper_of(tabulated(blanes_moan_s6{}), step / finer);
      const auto diverged_at = integrate_ensemble<T>(
          accurate, listed<Eigen::Dynamic>(at),
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
    if (system.bath().acts()) return;
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

  if (options.watches_growth && result.energy_was_watched && !result.lost) {
    result.growth_was_watched = true;
    std::vector<double> initial(starts.size(), 0.0);
    std::vector<double> early(starts.size(), 0.0);
    integrate_ensemble<T>(stepper, all,
                          {.trajectories = result.trajectories,
                           .steps = trial_result::early_steps,
                           .every = 1,
                           .seed = options.seed,
                           .threads = options.threads},
                          2, read, [&](std::int64_t m, std::int64_t n, std::span<const double> numbers) {
                            const auto number = static_cast<std::size_t>(m);
                            if (n == 0) initial[number] = numbers[0];
                            early[number] = std::max(early[number], std::abs(numbers[0] - initial[number]));
                          });
    for (std::size_t m = 0; m < early.size(); ++m) {
      if (!of_trajectory[m].is_left_out) result.early_deviation = std::max(result.early_deviation, early[m]);
    }
  }

  double magnitude = 0.0;
  double kinetic = 0.0;
  double observations = 0.0;
  for (std::size_t m = 0; m < of_trajectory.size(); ++m) {
    const auto& known = of_trajectory[m];
    if (known.is_left_out) continue;
    kinetic += known.kinetic;
    observations += known.observations;
    magnitude = std::max(magnitude, known.magnitude);
    result.first_deviation = std::max(result.first_deviation, known.first);
    if (known.largest > 0.0) {
      result.relative_deviation = std::max(result.relative_deviation, known.largest / known.peak);
    }
    if (known.largest <= result.deviation) continue;
    result.deviation = known.largest;
    result.farthest = {static_cast<std::int64_t>(m), known.at};
  }
  if (observations > 0.0) result.kinetic_energy = kinetic / observations;
  if (result.unconfined > 0 && result.kept() == 0) {
    result.not_run = "an accurate method loses every start too: the motion is not confined";
  }
  // Each letter rounds H once at most, in one direction at worst.
  result.rounding = static_cast<double>(options.steps) * static_cast<double>(method.letters().length) *
                    std::numeric_limits<double>::epsilon() * magnitude;
  return result;
}

}  // namespace

phase_points repeated_in_bath(const model& system, phase_points starts) {
  constexpr std::size_t enough = 192;
  const std::size_t given = starts.size();
  for (std::size_t k = 0; system.bath().acts() && given > 0 && starts.size() < enough; ++k) {
    starts.push_back(phase_point<double, Eigen::Dynamic>(starts[k % given]));
  }
  return starts;
}

trial_result trial_run(const model& system, const tabulated& method, double step, const phase_points& starts,
                       const trial_options& options) {
  const states points(starts.begin(), starts.end());
  return detail::with_scalar_of(
      system, [&]<class T>(T) { return run_in_lanes<T>(system, method, step, points, options); });
}

}  // namespace nysalt
