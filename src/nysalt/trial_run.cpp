// SPDX-License-Identifier: BSL-1.0
#include "nysalt/trial_run.hpp"

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
        static_cast<std::int64_t>(static_cast<double>(steps) / stretches));
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
                     left_out, deviation, first_deviation, energy_wanders() ? ": the energy drifts" : "");
}

}  // namespace nysalt
