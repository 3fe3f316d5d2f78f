// SPDX-License-Identifier: BSL-1.0
// Multiple time steps: where the kicks of the slow force resonate with fast modes.
#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "../../../examples/systems/bonded_chain.hpp"
#include "guard_of_parts.hpp"
#include "hard_case.hpp"
#include "nysalt/ensembles/given_states.hpp"
#include "nysalt/families/multiple_time_steps.hpp"
#include "nysalt/integrate.hpp"
#include "nysalt/learn.hpp"
#include "nysalt/learning/stability_guard.hpp"
#include "nysalt/references/fine_steps.hpp"

namespace nysalt::hard {

using namespace examples;

namespace {

constexpr int masses = 4;
constexpr double omega = 20.0;
const bonded_chain<masses> chain(stiff_bonds<masses>(omega), soft_charges<masses>(2.0));
const normal_around<masses> starts({vector<double, masses>::Zero(), vector<double, masses>::Zero()}, 0.01,
                                   0.3);
using learned_word = nested_kicks<0, 1, 4, 2>;

/// Largest |H - H_0| of four trajectories, those that diverge being infinite.
double largest_error(const method& method, double step, double time) {
  double largest = 0.0;
  for (std::uint64_t n = 0; n < 4; ++n) {
    const auto start = starts(7, n);
    const double initial = energy(chain, start);
    const auto look = [&](std::int64_t, double, const auto& x) {
      largest = std::max(largest, std::abs(energy(chain, x) - initial));
    };
    if (integrate(chain, method, step, start, std::llround(time / step), look).diverged_at) {
      return std::numeric_limits<double>::infinity();
    }
  }
  return largest;
}

flow_map_data data_at(double step, std::uint64_t seed) {
  const auto reference = fine_steps(step / std::ceil(step / 0.004));
  return make_flow_map_data(chain, starts, reference,
                            {.step = step, .horizon = 24 * step, .trajectories = 16, .seed = seed});
}

fit learned_at(double step, bool guarded) {
  return learn(learned_word{}, chain, data_at(step, 1), data_at(step, 2),
               {.random_starts = 4, .guarded = guarded});
}

verdict resonance_of_slow_kicks(extent how) {
  verdict result;
  const double time = 200.0;
  // The bonds' modes have the frequencies 2 omega sin(k pi/8), and r-RESPA solves these all but exactly with
  // 32 fast kicks: the charges, which add some 2 to their squares, move a resonance by less than 0.3 %.
  const double fastest = 2.0 * omega * std::sin(3.0 * std::numbers::pi / 8.0);
  const double resonant = 2.0 * std::numbers::pi / fastest;
  curve near{.label = "r-RESPA, 32 fast kicks", .x = {}, .y = {}};
  curve refused_near{.label = "the same, refused by the guard", .x = {}, .y = {}, .points_only = true};
  double at_resonance = 0.0;
  const model erased(chain);
  phase_points states;
  const auto along = data_at(0.1, 1);
  for (std::size_t k = 0; k < along.start.size(); ++k) {
    states.push_back(phase_point<double, Eigen::Dynamic>(along.start[k]));
  }
  const r_respa<0, 1, 32> respa;
  const detail::stability_guard guard(erased, states, respa.letters());
  const auto objection_at = [&](double step) {
    return guard.objection(respa.letters(), respa.coefficients(), step);
  };
  const auto try_at = [&](double step) {
    near.x.push_back(step);
    near.y.push_back(largest_error(respa, step, time));
    if (!objection_at(step).empty()) {
      refused_near.x.push_back(step);
      refused_near.y.push_back(near.y.back());
    }
    return near.y.back();
  };
  if (how == extent::full) {
    for (double step = 0.03; step < 0.98 * resonant; step *= 1.01) try_at(step);
  }
  for (int k = -5; k <= 5; ++k) {
    at_resonance = std::max(at_resonance, try_at(resonant * (1.0 + 0.001 * k)));
  }
  if (how == extent::full) {
    for (double step = 1.02 * resonant; step < 0.26; step *= 1.01) try_at(step);
  }
  // Growth by a factor at each step, of many in this time, against a bounded error.
  const double beside = largest_error(respa, 1.1 * resonant, time);
  result.require(
      at_resonance > 100.0 * beside,
      fmt::format("r-RESPA whose slow kicks are one period of the fastest mode apart, {:.3f}: energy "
                  "error {:.1e}; at steps 10 % longer {:.1e}",
                  resonant, at_resonance, beside));

  result.require(
      !refused_near.x.empty() && objection_at(1.1 * resonant).empty(),
      fmt::format("the guard refuses {} of {} steps, near the resonance among them, and not {:.3f}",
                  refused_near.x.size(), near.x.size(), 1.1 * resonant));

  curve shortly{.label = "learned nested_4x2", .x = {}, .y = {}, .emphasised = true};
  curve for_long{.label = "the same, ten times as long", .x = {}, .y = {}, .points_only = true};
  curve refused{
      .label = "learned, not usable by the guard or the trial run", .x = {}, .y = {}, .points_only = true};
  const auto try_learned = [&](double step, bool must_hold) {
    const auto [theta, summary, method] = learned_at(step, true);
    if (!summary.usable) {
      const auto why = fmt::format("nothing usable was learned at {}: {}", step, summary.reason);
      if (must_hold)
        result.require(false, why);
      else
        result.note(why);
      const auto unguarded = learned_at(step, false).method;
      refused.x.push_back(0.5 * step);
      refused.y.push_back(largest_error(unguarded, step, 10.0 * time));
      return;
    }
    const double early = largest_error(method, step, time);
    const double late = largest_error(method, step, 10.0 * time);
    // Slow kicks, two a step, so that both axes count the same evaluations.
    shortly.x.push_back(0.5 * step);
    shortly.y.push_back(early);
    for_long.x.push_back(0.5 * step);
    for_long.y.push_back(late);
    const auto measured = fmt::format(
        "learned nested_4x2 at {}: energy error {:.1e}, in ten times as long {:.1e}", step, early, late);
    // A random walk multiplies the error by sqrt(10), a trend by 10.
    if (must_hold || late > 1.4 * early) result.require(late <= 1.4 * early, measured);
  };
  constexpr double named = 0.226;  // that of examples/two_forces.cpp
  std::vector<double> steps{named};
  if (how == extent::full) {
    steps = {0.12, 0.14, 0.15, 0.16, 0.17, 0.18, 0.19, 0.2, 0.21, 0.22, named, 0.23, 0.24, 0.25, 0.26};
  }
  for (const double step : steps) try_learned(step, step == named);
  result.show({{.title = "Four charges on stiff bonds",
                .x_label = "time between kicks of the slow force",
                .y_label = "largest energy error",
                .log_log = true,
                .curves = {near, refused_near, shortly, for_long, refused},
                .linear_x = true}},
              "Resonances of the slow kicks with bonds, and words that were learned between them and beyond.",
              1000);
  return result;
}

}  // namespace

topic several_forces() {
  return {
      "Several forces",
      {{"resonance_of_slow_kicks",
        "Four charges on bonds of omega = 20, whose kicks lie as far apart as a fast mode's period.",
        "A word that is learned with its kicks beyond the first resonance, and is usable, has no trend "
        "in its "
        "energy error.",
        "r-RESPA at a resonance, which the guard refuses.", resonance_of_slow_kicks},
       {"guard_of_slow_kicks",
        "What the guard that learn() has says beforehand of words with kicks of parts, and what 100 000 "
        "steps of them do: chains and coupled oscillators of several sizes and stiffnesses, r-RESPA and "
        "learned words. An error grows if the largest of the second half is more than 1.4 times that of "
        "the first, or a trajectory diverges; a bounded one is small below the kinetic energy.",
        "The guard refuses all whose error grows, and of those with a small bounded error a tenth at most.",
        "Words whose error grows, which are among those that are tried.", guard_of_slow_kicks}}};
}

}  // namespace nysalt::hard
