// SPDX-License-Identifier: BSL-1.0
// Atoms that run into each other, and wells that are too full for the step.
#include <fmt/format.h>

#include "energy_story.hpp"
#include "hard_case.hpp"
#include "nysalt/noises/counter_based.hpp"
#include "nysalt/systems/lennard_jones.hpp"
#include "nysalt/systems/phi4_chain.hpp"
#include "words.hpp"

namespace nysalt::hard {

namespace {

using two_atoms = lennard_jones<2, 2>;

/// Two atoms three apart, a little off head-on, that meet with the given energy.
phase_point<double, 4> about_to_collide(double energy) {
  const two_atoms system;
  phase_point<double, 4> x{vector<double, 4>(-1.5, 0.0, 1.5, 0.05), vector<double, 4>::Zero()};
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
  for (const auto& one : side_by_side(learned_fg4_for_fpu())) {
    if (one.learned) continue;
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
    }
    worst += fmt::format("{}{} {:.1e}", worst.empty() ? "" : ", ", one.label, share);
    curves.push_back(std::move(largest));
  }
  result.require(
      recovered,
      fmt::format("where step times rate is below 1/2, the error that is left after the collision is this "
                  "part of the largest in it: {}",
                  worst));

  int named = 0;
  int wrong = 0;
  std::string steps;
  for (const double energy : {1e5, 1e6, 1e7}) {
    const double step = 0.01;
    const auto start = about_to_collide(energy);
    const auto done = integrate(system, tabulated(verlet{}), step, start, 100);
    if (done.diverged_at) ++named;
    if (done.diverged_at != first_bad_step(system, tabulated(verlet{}), step, start, 100)) ++wrong;
    steps += fmt::format("{}{}", steps.empty() ? "" : ", ", done.diverged_at.value_or(-1));
  }
  result.note(fmt::format(
      "at the step 0.01 and energies 1e5, 1e6, 1e7 (step times rate {:.0f} to {:.0f}): diverged at "
      "the steps {} (-1: not)",
      0.01 * rate_at_turning_point(1e5), 0.01 * rate_at_turning_point(1e7), steps));
  result.require(
      wrong == 0,
      fmt::format("{} of 3 steps into the core are reported as diverged, all at their step", named));
  result.show({.name = "close_approach",
               .panels = {{.title = "Two atoms collide",
                           .x_label = "energy of the collision",
                           .y_label = "largest |H - H_0|/H_0 in it",
                           .log_log = true,
                           .curves = std::move(curves)}}},
              "Largest energy error in a collision, at 0.002 per evaluation.");
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
  const double time = how == extent::quick ? 300.0 : 20'000.0;
  verdict result;
  std::vector<curve> curves;
  const auto run = [&](double step, const char* what) {
    auto story = follow(chain, tabulated(verlet{}), step, start, std::llround(time / step),
                        fmt::format("{}, h = {:.3f}", what, step));
    curves.push_back(story.shown);
    return story;
  };
  const auto inside = run(0.9 * 2.0 / surely, "0.9 of the edge, all energy in one well");
  result.require(
      inside.has_no_trend(),
      fmt::format(
          "h = {:.3f}, 0.9 of the edge if one well held all energy: {:.2g} and {:.2g} in the halves of "
          "a time of {:.0f}",
          0.9 * 2.0 / surely, inside.early, inside.late, time));
  const auto between = run(0.9 * 2.0 / usually, "0.9 of the edge of the declared band");
  result.note(
      between.diverged_at
          ? fmt::format("h = {:.3f}, 0.9 of the edge of frequency_bands({}): diverged at step {}",
                        0.9 * 2.0 / usually, of_well, *between.diverged_at)
          : fmt::format("h = {:.3f}, 0.9 of the edge of frequency_bands({}): {:.2g} and {:.2g} in the halves",
                        0.9 * 2.0 / usually, of_well, between.early, between.late));
  const auto outside = run(1.1 * 2.0 / 2.0, "1.1 of the edge of the springs alone");
  const auto expected = first_bad_step(chain, tabulated(verlet{}), 1.1, start, 10'000);
  result.require(
      outside.diverged_at && outside.diverged_at == expected,
      fmt::format(
          "h = 1.1, beyond the edge of the springs alone: diverged at step {}, finite until there: {}",
          outside.diverged_at.value_or(-1), outside.finite ? "yes" : "no"));
  result.show(
      {.name = "phi4_edge", .panels = {energy_panel("phi^4 chain, Verlet", std::move(curves))}},
      "16 wells of energy 2 each, Verlet: a chain is stable at the frequencies that it may reach, not at "
      "those that it has at rest.");
  return result;
}

}  // namespace

topic collisions() {
  return {
      "Collisions and full wells",
      {{"close_approach",
        "Two Lennard-Jones atoms collide with energies of 1 to 10^4 times the depth of their well.",
        "Where step times rate at the turning point is below 1/2, the energy error comes back to a tenth of "
        "its "
        "largest when the atoms part. A step into the core is reported as diverged at its step.",
        "Steps of 0.01 at energies of 10^5 and more.", close_approach},
       {"phi4_edge",
        "A phi^4 chain of 16 wells near the edge of stability, which rises and falls with its energy.",
        "At 0.9 of the edge for the largest stiffness that the energy allows, the energy error has no trend.",
        "Beyond the edge of the springs alone it diverges, at its step.", wells_near_the_edge}}};
}

}  // namespace nysalt::hard
