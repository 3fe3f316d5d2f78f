// SPDX-License-Identifier: BSL-1.0
// Potentials with a kink, a singularity, or no bottom.
#include <fmt/format.h>

#include <numbers>

#include "energy_story.hpp"
#include "hard_case.hpp"
#include "nysalt/derivatives/check_force.hpp"
#include "words.hpp"

namespace nysalt::hard {

namespace {

/// V = |q|.
struct kink {
  static constexpr int dimension = 1;
  template <class T>
  T potential(const vector<T, 1>& q) const {
    using std::abs;
    return abs(q[0]);
  }
  template <class T>
  void force(const vector<T, 1>& q, vector<T, 1>& f) const {
    f[0] = select(q[0] < 0.0, T(1.0), T(-1.0));
  }
};

/// V = -1/|q| on a line.
struct centre {
  static constexpr int dimension = 1;
  template <class T>
  T potential(const vector<T, 1>& q) const {
    using std::abs;
    return T(-1.0) / abs(q[0]);
  }
  template <class T>
  void force(const vector<T, 1>& q, vector<T, 1>& f) const {
    using std::abs;
    f[0] = T(-1.0) / (q[0] * abs(q[0]));
  }
};

/// V = a q^2/2 + b q^3/3 + c q^4/4: no bottom where c < 0, or c = 0 and b != 0.
struct quartic {
  static constexpr int dimension = 1;
  double a;
  double b;
  double c;
  template <class T>
  T potential(const vector<T, 1>& q) const {
    return q[0] * q[0] * (T(0.5 * a) + q[0] * (b / 3.0) + q[0] * q[0] * (0.25 * c));
  }
  template <class T>
  void force(const vector<T, 1>& q, vector<T, 1>& f) const {
    f[0] = -(q[0] * (T(a) + q[0] * b + q[0] * q[0] * c));
  }
};

phase_point<double, 1> on_line(double q, double p) { return {vector<double, 1>(q), vector<double, 1>(p)}; }

verdict absolute_value(extent how) {
  const kink system;
  const auto start = on_line(1.0, 0.3);
  const double time = how == extent::quick ? 2'000.0 : 200'000.0;
  verdict result;
  std::vector<curve> over_time;
  std::vector<curve> over_step;
  const std::vector<contender> all{{"verlet", tabulated(verlet{})},
                                   {"mclachlan2", tabulated(mclachlan2{})},
                                   {"srkn6b", tabulated(srkn6b{})},
                                   {"srkn11b", tabulated(srkn11b{})}};
  bool bounded = true;
  bool of_low_order = true;
  std::string slopes;
  std::string halves;
  for (const auto& one : all) {
    curve against_step{.label = one.label, .x = {}, .y = {}};
    for (const double per_evaluation : {0.04, 0.02, 0.01, 0.005, 0.0025}) {
      auto story = follow(system, one, per_evaluation, start, time);
      against_step.x.push_back(per_evaluation);
      against_step.y.push_back(story.largest);
      bounded = bounded && !story.diverged_at && story.finite && story.largest < 1.0;
      if (per_evaluation != 0.01) continue;
      halves += fmt::format("{}{} {:.1e} and {:.1e}", halves.empty() ? "" : ", ", one.label, story.early,
                            story.late);
      over_time.push_back(std::move(story.shown));
    }
    const double slope = std::log(against_step.y.front() / against_step.y.back()) / std::log(16.0);
    of_low_order = of_low_order && slope < 1.5;
    slopes += fmt::format("{}{} {:.2f}", slopes.empty() ? "" : ", ", one.label, slope);
    over_step.push_back(std::move(against_step));
  }
  result.require(bounded, fmt::format("at 0.01 per evaluation, first and second half of a time of {:.0f}: {}",
                                      time, halves));
  result.require(of_low_order, fmt::format("the energy error falls with a power of the step of: {}", slopes));

  // The same without a kink: the judgement knows an order when it sees one.
  const quartic smooth{1.0, 0.0, 1.0};
  const double coarse = follow(smooth, all[2], 0.04, start, 200.0).largest;
  const double fine = follow(smooth, all[2], 0.01, start, 200.0).largest;
  const double of_smooth = std::log(coarse / fine) / std::log(4.0);
  result.require(of_smooth > 3.5, fmt::format("in a smooth well srkn6b has the order {:.2f}", of_smooth));

  const auto check =
      check_force(system, {vector<double, 1>(-0.7), vector<double, 1>(0.4), vector<double, 1>(0.0)});
  result.note(
      fmt::format("check_force, at -0.7, 0.4 and the kink itself: {}: it cannot see a kink", check.report()));
  result.show({.name = "kink",
               .panels = {energy_panel("V = |q|, 0.01 per evaluation", std::move(over_time)),
                          {.title = "V = |q|, against the step",
                           .x_label = "step per evaluation",
                           .y_label = "largest |H - H_0|/H_0",
                           .log_log = true,
                           .curves = std::move(over_step)}},
               .width = 1300},
              "A kink costs every method its order: more stages buy little.");
  return result;
}

verdict head_on(extent how) {
  const centre system;
  const int starts = how == extent::quick ? 100 : 1000;
  verdict result;
  bool finite = true;
  int wrong = 0;
  std::string counts;
  for (const double step : {1e-2, 1e-3, 1e-4}) {
    int named = 0;
    int silent = 0;
    const std::int64_t steps = std::llround(3.0 / step);
    for (int m = 0; m < starts; ++m) {
      const auto start = on_line(1.0 + 0.1 * (m + 0.5) / starts, 0.0);
      const double initial = energy<double>(system, start);
      double last = 0.0;
      const auto look = [&](std::int64_t, double, const auto& x) {
        last = energy<double>(system, x) - initial;
        finite = finite && is_finite(x) && std::isfinite(last);
      };
      const auto done = integrate(system, tabulated(verlet{}), step, start, steps, look, 64);
      if (done.diverged_at) ++named;
      if (!done.diverged_at && std::abs(last) > 1.0) ++silent;
      if (done.diverged_at &&
          done.diverged_at != first_bad_step(system, tabulated(verlet{}), step, start, steps))
        ++wrong;
    }
    counts += fmt::format("{}h = {:g}: {} and {}", counts.empty() ? "" : "; ", step, named, silent);
  }
  result.require(
      finite && wrong == 0,
      fmt::format("{} starts that fall into the centre; reported as diverged, and thrown out with an energy "
                  "that is off by more than |H_0| but less than 1000 of it: {}",
                  starts, counts));
  // 1 + h (p - h/2) = 0: the first step lands on the centre itself.
  const auto on_the_spot = integrate(system, tabulated(verlet{}), 0.5, on_line(1.0, -1.75), 100).diverged_at;
  result.require(on_the_spot == 1,
                 "a step that lands on the centre itself, where the force is infinite: diverged at "
                 "step 1");
  const auto leaving = follow(system, tabulated(verlet{}), 1e-2, on_line(1.0, 2.0), 100'000, "");
  result.require(!leaving.diverged_at && leaving.largest < 1e-3,
                 fmt::format("thrown outwards faster than it can return: not reported, energy error {:.1e}",
                             leaving.largest));
  return result;
}

verdict without_bottom(extent how) {
  verdict result;
  std::vector<curve> curves;
  const double start_at = 0.5;
  // V = -q^4, H = 0: p = sqrt 2 q^2, and q = q_0/(1 - sqrt 2 q_0 t) is infinite at 1/(sqrt 2 q_0).
  const quartic steep{0.0, 0.0, -4.0};
  const auto start = on_line(start_at, std::numbers::sqrt2 * start_at * start_at);
  const double end = 1.0 / (std::numbers::sqrt2 * start_at);
  const std::vector<double> steps =
      how == extent::quick ? std::vector{1e-2, 1e-3} : std::vector{1e-2, 1e-3, 1e-4, 1e-5};
  for (const double step : steps) {
    const auto many = std::llround(3.0 * end / step);
    const auto story =
        follow(steep, tabulated(verlet{}), step, start, many, fmt::format("-q^4, h = {:g}", step));
    const auto expected = first_bad_step(steep, tabulated(verlet{}), step, start, many);
    const double named_at = static_cast<double>(story.diverged_at.value_or(0)) * step;
    // q = 1/(sqrt 2 (end - t)), so that the fastest rate sqrt 12 q times h is 1 at end - t = 2.4 h.
    result.require(
        story.finite && story.diverged_at == expected && std::abs(named_at - end) <= 25.0 * step,
        fmt::format("-q^4, h = {:g}: diverged at step {}, t = {:.5f}; the motion itself ends at {:.5f}", step,
                    story.diverged_at.value_or(-1), named_at, end));
    curves.push_back(story.shown);
  }
  const quartic cubic{1.0, -1.0, 0.0};  // a well with a pass of height 1/6 at q = 1
  for (const double speed : {0.9, 1.1}) {
    const auto thrown = on_line(0.0, speed * std::sqrt(1.0 / 3.0));
    const auto story = follow(cubic, tabulated(verlet{}), 0.01, thrown, 100'000,
                              fmt::format("cubic, {} of the pass", speed));
    const auto expected = first_bad_step(cubic, tabulated(verlet{}), 0.01, thrown, 100'000);
    const bool stays = speed < 1.0;
    result.require(
        story.finite && story.diverged_at == expected && story.diverged_at.has_value() != stays,
        stays
            ? fmt::format("q^2/2 - q^3/3, thrown at 0.9 of the speed of the pass: stays, energy error {:.1e}",
                          story.largest)
            : fmt::format("at 1.1 of it: diverged at step {}", story.diverged_at.value_or(-1)));
    curves.push_back(story.shown);
  }
  result.show({.name = "unbounded", .panels = {energy_panel("No bottom", std::move(curves))}},
              "The energy error until the run is stopped.");
  return result;
}

}  // namespace

topic rough_potentials() {
  return {"Kinks, singularities and no bottom",
          {{"kink", "V = |q|, whose force jumps.",
            "The energy error stays below the energy itself, and falls no faster than with the power 1.5 of "
            "the step, whatever "
            "the order of the method.",
            "In a smooth well the same measurement finds the order.", absolute_value},
           {"head_on", "A fall into the centre of -1/|q|.",
            "Whoever is off by a thousand times the energy is reported as diverged at that step; nothing "
            "that is shown is "
            "not finite.",
            "Thrown outwards nothing may be reported.", head_on},
           {"unbounded_below", "V = -q^4, whose motion ends at a finite time, and a cubic well with a pass.",
            "Reported as diverged at its step, within 25 steps of the exact end; nothing that is shown is "
            "not finite.",
            "Below the pass nothing may diverge.", without_bottom}}};
}

}  // namespace nysalt::hard
