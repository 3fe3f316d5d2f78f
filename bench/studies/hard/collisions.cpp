// SPDX-License-Identifier: BSL-1.0
// Atoms that run into each other, and wells that are too full for the step.
#include <fmt/format.h>

#include "energy_story.hpp"
#include "hard_case.hpp"
#include "nysalt/noises/counter_noise.hpp"
#include "nysalt/systems/lennard_jones.hpp"
#include "nysalt/systems/phi4.hpp"
#include "words.hpp"

namespace nysalt::hard {

namespace {

using two_atoms = lennard_jones<2, 2>;

/// Two atoms, a little off head-on, that meet with the given energy.
phase_point<double, 4> about_to_collide(double energy, double apart = 3.0) {
  const two_atoms system;
  phase_point<double, 4> x{vector<double, 4>(0.0, 0.0, apart, 0.02), vector<double, 4>::Zero()};
  const double speed = std::sqrt(energy - system.potential(x.q));
  x.p[0] = speed;
  x.p[2] = -speed;
  return x;
}

/// How fast two atoms swing where they turn: 4 (r^-12 - r^-6) = E, and rate^2 = 2 V''(r) as they share the
/// mass.
double rate_at_turning_point(double energy) {
  const double sixth = 0.5 * (1.0 + std::sqrt(1.0 + energy));  // r^-6
  const double inverse_square = std::cbrt(sixth);
  return std::sqrt(2.0 * (624.0 * sixth * sixth - 168.0 * sixth) * inverse_square);
}

verdict close_approach(extent how) {
  const two_atoms system;
  const int energies = how == extent::quick ? 9 : 33;
  const double per_evaluation = 0.002;
  std::vector<curve> curves;
  verdict result;
  std::string worst;
  bool recovered = true;
  bool lost = false;
  for (const auto& one : side_by_side(learned_fg4_for_fpu())) {
    if (one.learned) continue;  // nothing was learned for collisions
    curve largest{.label = one.label, .x = {}, .y = {}};
    double share = 0.0;
    for (int k = 0; k < energies; ++k) {
      const double energy = std::pow(10.0, 4.0 * k / (energies - 1));
      const double z = one.step(per_evaluation) * rate_at_turning_point(energy);
      const auto story =
          follow(system, one, per_evaluation, about_to_collide(energy), 6.0 / std::sqrt(energy));
      largest.x.push_back(energy);
      largest.y.push_back(std::max(story.largest, 1e-17));
      // Well within the first window of each: what is off while they touch comes back when they part.
      if (z < 0.5) {
        recovered = recovered && !story.diverged_at && story.last <= std::max(0.1 * story.largest, 1e-12);
        share = std::max(share, story.last / story.largest);
      }
      if (z > 2.0 && one.label == "verlet") {
        lost = lost || story.diverged_at || story.last > 0.1 * story.largest;
      }
    }
    worst += fmt::format("{}{} {:.1e}", worst.empty() ? "" : ", ", one.label, share);
    curves.push_back(std::move(largest));
  }
  result.require(
      recovered,
      fmt::format("where step times rate is below 1/2, the error that is left after the collision is this "
                  "part of the largest in it: {}",
                  worst));

  result.require(lost, "where it is above 2, Verlet's is found not to come back");
  result.show({{.title = "Two atoms collide",
                .x_label = "energy of the collision",
                .y_label = "largest |H - H_0|/H_0 in it",
                .log_log = true,
                .curves = std::move(curves)}},
              "Largest energy error in a collision, at 0.002 per evaluation. Above an energy of some 1000 "
              "small errors are no "
              "good news: steps pass over the core, and atoms through each other, unnoticed.");
  return result;
}

/// Steps that are too long for the core: where they land decides.
verdict into_the_core(extent how) {
  const two_atoms system;
  const int starts = how == extent::quick ? 100 : 1000;
  verdict result;
  bool finite = true;
  int wrong = 0;
  int all_named = 0;
  for (const double energy : {1e2, 1e3, 1e4}) {
    const double step = 0.02;
    const double z = step * rate_at_turning_point(energy);
    int named = 0;
    int heated = 0;
    int passed = 0;
    int bounced = 0;
    for (int m = 0; m < starts; ++m) {
      const auto start = about_to_collide(energy, 3.0 + 1.5 * m / starts);
      const double initial = nysalt::energy<double>(system, start);
      double last = 0.0;
      const auto look = [&](std::int64_t, double, const auto& x) {
        last = nysalt::energy<double>(system, x) / initial - 1.0;
        finite = finite && is_finite(x);
      };
      const std::int64_t steps = std::llround(6.0 / std::sqrt(energy) / step) + 4;
      const auto done = integrate(system, verlet{}, step, start, steps, look);
      if (done.diverged_at != first_bad_step(system, verlet{}, step, start, steps)) ++wrong;
      if (done.diverged_at) {
        ++named;
      } else if (done.finish.q[2] < done.finish.q[0]) {
        ++passed;
      } else if (std::abs(last) > 0.1) {
        ++heated;
      } else {
        ++bounced;
      }
    }
    all_named += named;
    result.note(
        fmt::format("energy {:g}, step times rate {:.1f}: of {} collisions {} are reported as diverged, {} "
                    "bounce, {} come out "
                    "with an energy that is off by more than a tenth, {} pass through each other",
                    energy, z, starts, named, bounced, heated, passed));
  }
  result.require(finite && wrong == 0 && all_named > 0,
                 fmt::format("{} are reported, each at the step where it is off by 1000 times the energy, "
                             "and nothing that is shown is "
                             "not finite",
                             all_named));
  int harmed = 0;
  for (int m = 0; m < starts; ++m) {
    const auto start = about_to_collide(100.0, 3.0 + 1.5 * m / starts);
    const auto story = follow(system, verlet{}, 0.001, start, 700, "");
    harmed += story.diverged_at || story.last > 0.001;
  }
  result.require(harmed == 0,
                 "at the step 0.001 all bounce at energy 100, and keep their energy to a thousandth");
  return result;
}

/// Momenta such that the chain holds so much energy a well; all at rest at the bottom.
phase_point<double, Eigen::Dynamic> kicked(const phi4_chain<>& chain, double energy_per_well) {
  phase_point<double, Eigen::Dynamic> x{Eigen::VectorXd::Zero(chain.size()), Eigen::VectorXd(chain.size())};
  standard_normals(1, {.purpose = noise_purpose::initial_state}, x.p);
  x.p *= std::sqrt(2.0 * energy_per_well * static_cast<double>(chain.size())) / x.p.norm();
  return x;
}

/// The bands are those of wells that hold up to so much energy each; of E in all, one well may hold E.
verdict wells_near_the_edge(extent how) {
  const phi4_chain<> chain(16);
  const double of_well = 2.0;
  const auto start = kicked(chain, of_well);
  const double all = 16.0 * of_well;
  const double surely = std::sqrt(4.0 + 6.0 * std::sqrt(all));
  const double usually = chain.frequency_bands(of_well).front().high;
  const double time = how == extent::quick ? 20'000.0 : 200'000.0;
  verdict result;
  std::vector<curve> curves;
  const auto run = [&](double step, const char* what) {
    auto story = follow(chain, verlet{}, step, start, std::llround(time / step),
                        fmt::format("{}, h = {:.3f}", what, step));
    curves.push_back(story.shown);
    return story;
  };
  // Verlet turns the phase of an oscillation by arccos(1 - z^2/2) a step: a quarter of a turn at z = sqrt 2,
  // a third at sqrt 3, where nonlinear forces pump it. 0.65 of the edge is z = 1.3, below both.
  const auto inside = run(0.65 * 2.0 / surely, "0.65 of the surest edge");
  result.require(
      inside.has_no_trend(),
      fmt::format(
          "h = {:.3f}, 0.65 of the edge for all energy in one well: {:.2g} and {:.2g} in the halves of a "
          "time of {:.0f}",
          0.65 * 2.0 / surely, inside.early, inside.late, time));
  const auto pumped = run(0.9 * 2.0 / surely, "0.9 of it");
  result.require(
      !pumped.has_no_trend(),
      fmt::format("h = {:.3f}, 0.9 of that edge, z = 1.8 above the resonances: {}", 0.9 * 2.0 / surely,
                  pumped.diverged_at ? fmt::format("diverged after all, at step {}", *pumped.diverged_at)
                                     : fmt::format("{:.2g} and {:.2g}", pumped.early, pumped.late)));
  const auto between = run(0.9 * 2.0 / usually, "0.9 of the edge of the mean energy");
  result.note(
      between.diverged_at
          ? fmt::format("h = {:.3f}, 0.9 of the edge of frequency_bands({}): diverged at step {}",
                        0.9 * 2.0 / usually, of_well, *between.diverged_at)
          : fmt::format("h = {:.3f}, 0.9 of the edge of frequency_bands({}): {:.2g} and {:.2g} in the halves",
                        0.9 * 2.0 / usually, of_well, between.early, between.late));
  const auto outside = run(1.1 * 2.0 / 2.0, "1.1 of the edge of the springs");
  const auto expected = first_bad_step(chain, verlet{}, 1.1, start, 10'000);
  result.require(
      outside.diverged_at && outside.diverged_at == expected,
      fmt::format(
          "h = 1.1, beyond the edge of the springs alone: diverged at step {}, finite until there: {}",
          outside.diverged_at.value_or(-1), outside.finite ? "yes" : "no"));
  result.show(
      {energy_panel("phi^4 chain, Verlet", std::move(curves))},
      "16 wells of energy 2 each, Verlet. The edge is that of the frequencies that a well may reach, not of "
      "those at rest, and a third below it lie nonlinear resonances.");
  return result;
}

}  // namespace

topic collisions() {
  return {
      "Collisions and full wells",
      {{"close_approach",
        "Two Lennard-Jones atoms collide with energies of 1 to 10^4 times the depth of their well.",
        "Where step times rate at the turning point is below 1/2, the energy error comes back to a tenth of "
        "its largest when the atoms part.",
        "Where it is above 2, Verlet's does not come back.", close_approach},
       {"into_the_core", "The same with a step of 0.02, too long for the core, from many distances.",
        "Whoever is off by a thousand times the energy is reported as diverged at that step, and nothing "
        "that "
        "is shown is not finite.",
        "At a step of 0.001 nobody is reported, and none loses a thousandth of its energy.", into_the_core},
       {"phi4_edge",
        "A phi^4 chain of 16 wells near the edge of stability, which rises and falls with its energy.",
        "At 0.65 of the edge for the largest stiffness that the energy allows, below the nonlinear "
        "resonances at z = "
        "sqrt 2 and sqrt 3, Verlet's energy error has no trend.",
        "At 0.9 of it, linearly stable, the energy is pumped until it diverges; beyond the edge of the "
        "springs alone it "
        "does so at once, at its step.",
        wells_near_the_edge}}};
}

}  // namespace nysalt::hard
