// SPDX-License-Identifier: BSL-1.0
// Stability margin of a step for a system, as far as its frequencies are known.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "json.hpp"
#include "nysalt/derivatives/stability_margin.hpp"
#include "prepared_problem.hpp"

namespace nysalt::program {

/// The relative distance that a step should keep from the end of its window, as nonlinear systems leave it
/// earlier. Under Verlet, of 256 trajectories to t = 2000, phi4, lennard_jones and henon_heiles lose 3, 8 and
/// 1 just below the end, and none at four fifths of it.
inline constexpr double wanted_margin = 0.2;
/// The relative distance of linear_step from the first end, or to a quarter of a turn of the fastest
/// oscillation, whichever comes first: nonlinear motion is lost at the resonances of low order, where a step
/// turns by a half, a third or a quarter, long before a linear one is [schlick_mandziuk_skeel_srinivas_1998].
inline constexpr double linear_margin = 0.3;
inline constexpr double turn_margin = 0.05;
/// The relative distance of a safe step from the largest step at which a trial run passed. The pendulum under
/// Verlet is the standard map, whose last invariant circle breaks at h = sqrt(.9716) [greene_1979]: just
/// beyond, momenta diffuse too slowly for a trial run to see.
inline constexpr double tried_margin = 0.2;

/// Angular frequencies that a system is asked to be stable for: its bands; where it declares none those that
/// are met along the motion, where they lie far apart, and else 0 to the highest. The last band goes up to
/// the highest of what is known beside.
struct known_frequencies {
  std::vector<frequency_band> bands;
  std::optional<double> declared;  // these three: the highest, by where it is known from
  double of_law;
  std::optional<double> along_starts;
  std::uint64_t starts = 0;
  bool are_of_motion = false;  // the bands

  double highest() const;
  /// "declared", or else.
  std::string source() const;
};
/// Facts that cost little work.
known_frequencies frequencies_of(const prepared_problem& system);
/// And along that number of initial states, if that is not expensive.
known_frequencies frequencies_along_starts(const prepared_problem& system, std::uint64_t seed,
                                           std::uint64_t count);

struct judged_band {
  frequency_band band;
  bool stable;
  double margin;                   // see stability_margin()
  std::optional<double> touching;  // z within 2 % of it, where two windows touch
};

struct judged_step {
  std::vector<judged_band> bands;
  std::vector<stability_window> gaps;  // below the highest z
  std::vector<step_range> stable_steps;
  double linear_step;  // by the linear criterion nothing below it is unstable, touches or turns by a quarter,
                       // on 0 to the highest, with the margins above; 0 if there is none

  bool is_stable() const;
  double margin() const;  // the least
};
judged_step judge(const tabulated& method, const stability_chart& chart, const known_frequencies& frequencies,
                  double step);

/// "by the linear criterion steps up to 0.0317 have a margin of 30 %"
std::string advice(const judged_step& judged);

/// A trial run at a step, as long as is affordable for the size of the system.
trial_result try_step(const tabulated& method, const prepared_problem& system, double step,
                      std::uint64_t seed, int threads);
/// A step at which nothing is lost, nor at shorter ones: the largest of linear_step, 4/5 of it and so on such
/// that trial runs pass at 5/4 of it, at it and at 4/5, 16/25 and 64/125 of it, and at it no trajectory's
/// energy errs by as much as the trajectory's largest kinetic energy. Nothing if there is none, if the word
/// rotates, or if the system's frequencies have no bound. A step that failed bounds it from above. Cost: a
/// trial run for each step that is tried.
std::optional<double> safe_step(const tabulated& method, const prepared_problem& system,
                                const judged_step& judged, std::optional<double> failed, std::uint64_t seed,
                                int threads);
json to_json(const trial_result& trial);

/// One sentence where linear windows say nothing, of a word that rotates or where frequencies have no bound,
/// and a trial run fails. Cost: that of a trial run of at most that number of steps.
std::optional<std::string> failed_trial(const std::string& name, const tabulated& method,
                                        const prepared_problem& system, double step, std::int64_t steps,
                                        std::uint64_t seed, int threads);

/// One sentence where the step is unstable on what is known without work, or of a word that rotates, where
/// soft forces magnify a mode.
std::optional<std::string> instability(const std::string& name, const tabulated& method,
                                       const prepared_problem& system, double step);

/// One sentence where it is stable on that, but near the end of a window, on frequencies where two touch, or,
/// over that number of steps, near a resonance; or not stable any more on those of the first starts of a
/// seed. Cost: where there are at most a thousand coordinates, some hundred force evaluations for each of 16
/// starts; else nothing.
std::optional<std::string> stability_warning(const std::string& name, const tabulated& method,
                                             const prepared_problem& system, double step, std::int64_t steps,
                                             std::uint64_t seed);

}  // namespace nysalt::program
