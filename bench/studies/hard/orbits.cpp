// SPDX-License-Identifier: BSL-1.0
// Eccentric ellipses and chaos: motion that is slow for long and fast at times.
#include <fmt/format.h>

#include <numbers>

#include "energy_story.hpp"
#include "hard_case.hpp"
#include "nysalt/systems/textbook.hpp"
#include "words.hpp"

namespace nysalt::hard {

namespace {

/// Semi-major axis 1, at the pericentre.
phase_point<double, 2> at_pericentre(double eccentricity) {
  return {vector<double, 2>(1.0 - eccentricity, 0.0),
          vector<double, 2>(0.0, std::sqrt((1.0 + eccentricity) / (1.0 - eccentricity)))};
}

/// The classical method of Runge and Kutta: order 4 and not symplectic, what must not pass as bounded.
energy_story runge_kutta(const auto& system, double step, phase_point<double, 2> x, std::int64_t steps) {
  using state = phase_point<double, 2>;
  energy_watch watch(energy<double>(system, x), static_cast<double>(steps) * step);
  const auto rate = [&](const state& at) {
    state result{at.p, at.q};
    system.force(at.q, result.p);
    return result;
  };
  const auto moved = [](const state& from, double by, const state& along) {
    return state{from.q + by * along.q, from.p + by * along.p};
  };
  for (std::int64_t n = 1; n <= steps; ++n) {
    const state k1 = rate(x);
    const state k2 = rate(moved(x, 0.5 * step, k1));
    const state k3 = rate(moved(x, 0.5 * step, k2));
    const state k4 = rate(moved(x, step, k3));
    x = moved(moved(x, step / 6.0, k1), step / 3.0, k2);
    x = moved(moved(x, step / 3.0, k3), step / 6.0, k4);
    watch.see(static_cast<double>(n) * step, energy<double>(system, x));
  }
  return watch.told("Runge-Kutta, order 4");
}

double angular_momentum(const phase_point<double, 2>& x) { return x.q[0] * x.p[1] - x.q[1] * x.p[0]; }

struct ellipse {
  double eccentricity;
  double per_evaluation;  // step, such that the pericentre takes some steps
};

verdict ellipses(const ellipse& orbit, extent how) {
  const kepler system;
  const auto start = at_pericentre(orbit.eccentricity);
  const double periods = how == extent::quick ? (orbit.eccentricity > 0.95 ? 4.0 : 20.0) : 400.0;
  const double time = periods * 2.0 * std::numbers::pi;
  verdict result;
  std::vector<curve> curves;
  std::string errors;
  bool bounded = true;
  for (const auto& one : side_by_side(learned_fg4_for_kepler())) {
    auto story = follow(system, one, orbit.per_evaluation, start, time);
    bounded = bounded && story.has_no_trend();
    errors += fmt::format("{}{} {:.1e}", errors.empty() ? "" : ", ", one.label, story.largest);
    if (!story.has_no_trend()) {
      errors += fmt::format(" (not bounded: {:.2e} in the first half, {:.2e} in the second)", story.early,
                            story.late);
    }
    curves.push_back(std::move(story.shown));
  }
  result.require(bounded,
                 fmt::format("{:.0f} revolutions at {} evaluations each; largest energy error: {}", periods,
                             std::llround(2.0 * std::numbers::pi / orbit.per_evaluation), errors));

  // Kicks are central and drifts straight: each conserves q x p, and rounds its two products by eps.
  const double step = 2.0 * orbit.per_evaluation;
  const std::int64_t steps = std::llround(time / step);
  const double momentum = angular_momentum(start);
  double off = 0.0;
  double largest_product = 0.0;
  const auto look = [&](std::int64_t, double, const auto& x) {
    off = std::max(off, std::abs(angular_momentum(x) - momentum));
    largest_product = std::max(largest_product, x.q.norm() * x.p.norm());
  };
  integrate(system, mclachlan2{}, step, start, steps, look);
  const double rounding = 5.0 * static_cast<double>(steps) * 4.0 * 2.2e-16 * largest_product;
  result.require(
      off <= rounding,
      fmt::format("mclachlan2: angular momentum off by {:.1e}, rounding allows {:.1e}", off, rounding));

  const double of_four = 4.0 * orbit.per_evaluation;
  auto drifting = runge_kutta(system, of_four, start, std::llround(time / of_four));
  result.require(
      !drifting.has_no_trend(),
      fmt::format(
          "Runge and Kutta's method is found to drift: {:.1e} in the first half, {:.1e} in the second",
          drifting.early, drifting.late));
  curves.push_back(std::move(drifting.shown));
  result.show({energy_panel(fmt::format("Kepler, eccentricity {}", orbit.eccentricity), std::move(curves))},
              fmt::format("Energy error of an ellipse of eccentricity {} at {} per evaluation.",
                          orbit.eccentricity, orbit.per_evaluation));
  return result;
}

/// What a step does that suits e = 0.6 and not 0.99.
verdict pericentre_missed(extent) {
  const kepler system;
  const double eccentricity = 0.99;
  const phase_point<double, 2> at_apocentre{
      vector<double, 2>(1.0 + eccentricity, 0.0),
      vector<double, 2>(0.0, std::sqrt((1.0 - eccentricity) / (1.0 + eccentricity)))};
  const double step = 0.01;
  const double rate = std::pow(1.0 - eccentricity, -1.5);
  verdict result;
  const auto try_it = [&](const method& method) {
    const std::int64_t steps = 10'000;
    const auto story = follow(system, method, step, at_apocentre, steps, "");
    const auto expected = first_bad_step(system, method, step, at_apocentre, steps);
    result.require(
        story.finite && story.diverged_at == expected && story.largest > 1.0,
        fmt::format(
            "{}, step times rate {:.0f} at the pericentre: the energy is off by {:.0f} times its size; {}",
            method.name(), step * rate, story.largest,
            story.diverged_at ? fmt::format("reported as diverged at step {}", *story.diverged_at)
                              : "that is not reported as divergence, which begins at 2000 times here"));
  };
  try_it(verlet{});
  try_it(mclachlan2{});
  const auto sound = follow(system, verlet{}, 1e-5, at_apocentre, 1'000'000, "", false, 64);
  result.require(!sound.diverged_at && sound.largest < 1.0,
                 fmt::format("at a step of 1e-5 Verlet's energy is off by {:.1e} at most", sound.largest));
  return result;
}

/// On the y axis, with the rest of the energy in p_x.
phase_point<double, 2> at_energy(double energy, double y) {
  const henon_heiles system;
  const vector<double, 2> q(0.0, y);
  return {q, vector<double, 2>(std::sqrt(2.0 * (energy - system.potential(q))), 0.0)};
}

verdict chaos(extent how) {
  const henon_heiles system;
  const double time = how == extent::quick ? 500.0 : 20'000.0;
  const double per_evaluation = 0.04;
  verdict result;
  std::vector<panel> panels;
  for (const double of : {1.0 / 8.0, 1.0 / 6.0 - 1e-6}) {
    const auto start = at_energy(of, -0.1);
    std::string errors;
    bool bounded = true;
    std::vector<curve> curves;
    for (const auto& one : side_by_side(learned_fg4_for_henon_heiles())) {
      auto story = follow(system, one, per_evaluation, start, time);
      bounded = bounded && story.has_no_trend();
      errors += fmt::format("{}{} {:.1e}", errors.empty() ? "" : ", ", one.label, story.largest);
      curves.push_back(std::move(story.shown));
    }
    result.require(bounded, fmt::format("energy {:.6f} for a time of {:.0f}: {}", of, time, errors));
    panels.push_back(energy_panel(fmt::format("Henon-Heiles, energy {:.4f}", of), std::move(curves)));
  }
  auto drifting = runge_kutta(system, 4.0 * per_evaluation, at_energy(1.0 / 8.0, -0.1),
                              std::llround(time / (4.0 * per_evaluation)));
  result.require(!drifting.has_no_trend(),
                 fmt::format("Runge and Kutta's drifts: {:.1e} in the first half, {:.1e} in the second",
                             drifting.early, drifting.late));
  panels.front().curves.push_back(std::move(drifting.shown));
  result.show(std::move(panels), "Energy error of chaotic motion at 0.04 per evaluation.", 1300);
  return result;
}

/// Above 1/6 the triangle is open at its corners.
verdict escapes(extent how) {
  const henon_heiles system;
  const int starts = how == extent::quick ? 30 : 200;
  const double step = 0.05;
  const std::int64_t steps = how == extent::quick ? 4'000 : 20'000;
  const auto count_escapes = [&](double of, verdict& into) {
    int escaped = 0;
    int wrong = 0;
    bool finite = true;
    double farthest = 0.0;
    std::int64_t soonest = steps;
    for (int m = 0; m < starts; ++m) {
      const auto start = at_energy(of, -0.3 + 0.6 * (m + 0.5) / starts);
      const auto look = [&](std::int64_t, double, const auto& x) {
        finite = finite && is_finite(x);
        farthest = std::max(farthest, x.q.norm());
      };
      const auto done = integrate(system, verlet{}, step, start, steps, look);
      if (done.diverged_at) ++escaped;
      if (done.diverged_at) soonest = std::min(soonest, *done.diverged_at);
      const auto expected =
          done.diverged_at ? first_bad_step(system, verlet{}, step, start, steps) : std::nullopt;
      if (done.diverged_at != expected) ++wrong;
    }
    into.require(
        finite && wrong == 0,
        fmt::format("energy {:.3f}: {} of {} escape within {} steps{}; nothing that was shown is not finite, "
                    "the farthest at |q| = {:.1f}",
                    of, escaped, starts, steps,
                    escaped > 0 ? fmt::format(", the first at {}, each named at its step", soonest) : "",
                    farthest));
    return escaped;
  };
  verdict result;
  result.require(count_escapes(0.2, result) > starts / 2, "above 1/6 most do");
  result.require(count_escapes(1.0 / 8.0, result) == 0, "at 1/8 none may, and none does");
  return result;
}

}  // namespace

topic orbits() {
  const std::string of_kepler =
      "The energy error has no trend: in the second half of the time it is at most 1.4 times that in the "
      "first (a "
      "drift doubles it). Angular momentum is conserved to rounding.";
  const std::string of_runge = "The classical method of Runge and Kutta drifts.";
  return {"Eccentric and chaotic orbits",
          {{"kepler_60", "Kepler's ellipse of eccentricity 0.6.", of_kepler, of_runge,
            [](extent how) {
              return ellipses({0.6, 0.01}, how);
            }},
           {"kepler_90", "Of eccentricity 0.9: 32 times faster at the pericentre than on a circle.",
            of_kepler, of_runge,
            [](extent how) {
              return ellipses({0.9, 0.001}, how);
            }},
           {"kepler_99", "Of eccentricity 0.99: a thousand times faster.", of_kepler, of_runge,
            [](extent how) {
              return ellipses({0.99, 3e-5}, how);
            }},
           {"pericentre_missed", "Eccentricity 0.99 at a step that suits 0.6.",
            "The energy error shows it: it exceeds the energy itself. Where it exceeds a thousand, the run "
            "is reported as diverged at that step.",
            "The run itself: it has no bounded energy error.", pericentre_missed},
           {"henon_heiles", "Henon and Heiles' system at the chaotic energies 1/8 and (nearly) 1/6.",
            "The energy error has no trend, chaos or not.", of_runge, chaos},
           {"henon_heiles_escapes", "The same at the energy 0.2, where the triangle is open at its corners.",
            "Whoever escapes is reported as diverged at its step, and no state that is shown is not finite.",
            "At 1/8 nobody may escape.", escapes}}};
}

}  // namespace nysalt::hard
