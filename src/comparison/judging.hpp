// SPDX-License-Identifier: BSL-1.0
// Judgements of methods at steps, as documents and sentences, and the steps that they advise.
#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "json.hpp"
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

/// A number that a document can hold: null where it is not finite.
inline json finite(double x) { return std::isfinite(x) ? json(x) : json(nullptr); }

/// A judgement as every document shows it.
json to_json(const judgement& found);

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

/// Beside a method that loses trajectories: the classical method that loses the fewest at equal cost, of the
/// five with the longest stability windows an evaluation, as on close encounters every fixed step loses
/// some. Nothing where at most 2 % are lost, and in a bath. Cost: five trials at most.
std::optional<rival_judgement> loses_fewest(const method& method, const prepared_problem& system,
                                            const judgement& found, int threads);
/// "at equal cost verlet at step 0.05 loses the fewest trajectories, 3.1 %"
std::string in_words(const rival_judgement& rival);
/// Of the one or of none.
json to_json(const std::optional<rival_judgement>& rival);

}  // namespace nysalt::program
