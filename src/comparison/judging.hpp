// SPDX-License-Identifier: BSL-1.0
// Judgements of methods at steps, as documents and sentences, and the steps that they advise.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "measurement.hpp"
#include "nysalt/derivatives/linear_stability.hpp"
#include "nysalt/judgement.hpp"
#include "prepared_problem.hpp"

namespace nysalt::program {

/// The relative distance of linear_step from the first end of stability, or to a quarter of a turn of the
/// fastest oscillation, whichever comes first: nonlinear motion is lost at the resonances of low order, where
/// a step turns by a half, a third or a quarter, long before a linear one is
/// [schlick_mandziuk_skeel_srinivas_1998].
inline constexpr double linear_margin = 0.3;
inline constexpr double turn_margin = 0.05;
/// The relative distance of a safe step from the largest step at which a method was tried. The pendulum
/// under Verlet is the standard map, whose last invariant circle breaks at h = sqrt(.9716) [greene_1979]:
/// just beyond, momenta diffuse too slowly for a trial to see.
inline constexpr double tried_margin = 0.2;

/// Energy errors of the trajectories of a trial, and their course along it.
struct energy_of_trial : judgement::energy_errors {
  double drift;
  double growth;
};
NYSALT_DESCRIBED(energy_of_trial, median, most, nearly_all, largest, drift, growth)
/// Nothing where the energy was not watched, and where all trajectories diverged.
std::optional<energy_of_trial> energy_error_of(const judgement& found);

constexpr auto members(of<judgement>) {
  return std::tuple(
      NYSALT_MEMBERS(judgement, verdict, reason, step, trajectories, unconfined, steps, lost, diverged,
                     exceeding, share_lost, most_lost, first_lost),
      item{"energy_error", energy_error_of},
      item{"kinetic_energy",
           [](const judgement& found) { return only_if(found.energy_was_watched, found.kinetic_energy); }},
      item{"highest_frequency",
           [](const judgement& found) {
             return only_if(found.highest_frequency > 0.0, found.highest_frequency);
           }},
      NYSALT_MEMBERS(judgement, frequencies, margin, linear_objection, resonance));
}

/// Verdict and reason with the name of the method, where these are to be said: unless it is good.
std::optional<std::string> warning_of(const std::string& name, const judgement& found);

/// By the linear criterion nothing below this step is unstable, touches or turns by a quarter on frequencies
/// from 0 to the highest, with the margins above; 0 if there is none.
double linear_step(const nysalt::method& method, const stability_chart& chart, double highest_frequency);
/// "by the linear criterion steps up to 0.0317 have a margin of 30 %"
std::string advice(double linear_step);

/// A step at which a method keeps all trajectories, as at shorter ones: the largest of linear_step, 4/5 of it
/// and so on such that at 5/4 of it, at it and at 4/5, 16/25 and 64/125 of it none is lost in a trial, and no
/// energy errs by as much as the kinetic energy. Nothing if there is none, if the word has no windows, or if
/// the system's frequencies have no bound. Cost: a trial for each step.
std::optional<double> safe_step(const nysalt::method& method, const prepared_problem& system,
                                double linear_step, int threads);

/// A classical method judged at the step where it costs as much as another method.
struct rival_judgement {
  std::string method;
  judgement found;
};

constexpr auto members(of<rival_judgement>) {
  return std::tuple(item{"method", &rival_judgement::method},
                    item{"step", [](const rival_judgement& rival) { return rival.found.step; }},
                    item{"verdict", [](const rival_judgement& rival) { return rival.found.verdict; }},
                    item{"share_lost", [](const rival_judgement& rival) { return rival.found.share_lost(); }},
                    item{"most_lost", [](const rival_judgement& rival) { return rival.found.most_lost(); }});
}

/// Beside a method that loses trajectories: the classical method that loses the fewest at equal cost, of the
/// five with the longest stability windows an evaluation, as on close encounters every fixed step loses
/// some. Nothing where at most 2 % are lost, and in a bath. Cost: five trials at most.
std::optional<rival_judgement> loses_fewest(const method& method, const prepared_problem& system,
                                            const judgement& found, int threads);
/// "at equal cost verlet at step 0.05 loses the fewest trajectories, 3.1 %"
std::string in_words(const rival_judgement& rival);

}  // namespace nysalt::program
