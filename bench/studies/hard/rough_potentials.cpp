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

/// Least squares of log y over log x: the power of x.
double power_of(const curve& points) {
  double x_mean = 0.0;
  double y_mean = 0.0;
  const auto n = static_cast<double>(points.x.size());
  for (std::size_t i = 0; i < points.x.size(); ++i) {
    x_mean += std::log(points.x[i]) / n;
    y_mean += std::log(points.y[i]) / n;
  }
  double xx = 0.0;
  double xy = 0.0;
  for (std::size_t i = 0; i < points.x.size(); ++i) {
    xx += (std::log(points.x[i]) - x_mean) * (std::log(points.x[i]) - x_mean);
    xy += (std::log(points.x[i]) - x_mean) * (std::log(points.y[i]) - y_mean);
  }
  return xy / xx;
}

/// Falls from rest at about 1, past the kink at t = 1.4 and no further: the worst energy error of starts that
/// meet it at all phases of a step.
double error_of_crossing(const method& method, double step) {
  const kink system;
  constexpr int phases = 64;
  double worst = 0.0;
  for (int m = 0; m < phases; ++m) {
    const auto start = on_line(1.0 + 2.0 * step * m / phases, 0.0);
    const auto x = integrate(system, method, step, start, std::llround(2.2 / step)).finish;
    worst = std::max(worst, std::abs(energy<double>(system, x) - energy<double>(system, start)));
  }
  return worst;
}

verdict absolute_value(extent how) {
  const kink system;
  verdict result;
  std::vector<curve> over_step;
  std::vector<curve> over_time;
  std::string powers;
  bool of_order_one = true;
  const double time = how == extent::quick ? 1'000.0 : 100'000.0;
  for (const contender& one : {contender{"verlet", verlet{}},
                               {"mclachlan2", mclachlan2{}},
                               {"srkn6b", srkn6b{}},
                               {"srkn11b", srkn11b{}}}) {
    curve against_step{.label = one.label, .x = {0.02, 0.01, 0.005, 0.0025, 0.00125}, .y = {}};
    for (const double per_evaluation : against_step.x) {
      against_step.y.push_back(error_of_crossing(one.method, one.step(per_evaluation)));
    }
    const double power = power_of(against_step);
    of_order_one = of_order_one && power > 0.75 && power < 1.25;  // 64 phases miss the worst by some 3 %
    powers += fmt::format("{}{} {:.2f}", powers.empty() ? "" : ", ", one.label, power);
    over_step.push_back(std::move(against_step));
    auto story = follow(system, one, 0.04, on_line(1.0, 0.55), time);
    result.note(
        fmt::format("{} at 0.04 per evaluation for a time of {:.0f}: off by {:.1e} in the first half and "
                    "{:.1e} in the second",
                    one.label, time, story.early, story.late));
    over_time.push_back(std::move(story.shown));
  }
  result.require(of_order_one,
                 fmt::format("the energy error of a crossing falls with the step to the power: {}", powers));
  // Verlet is exact on either side. Where the force jumps within a step from q > 0, H changes by
  // h |p| + h^2/2 - 2 q, and q < h |p| + h^2/2.
  const double h = 0.01;
  const double most = h * (std::sqrt(2.0 * (1.0 + 2.0 * h)) + h) + 0.5 * h * h;
  const double of_verlet = error_of_crossing(verlet{}, h);
  result.require(of_verlet <= most,
                 fmt::format("Verlet's at h = 0.01 is {:.4f} at most, its bound h |p| + h^2/2 = {:.4f}",
                             of_verlet, most));

  // The same without a kink: the judgement knows an order when it sees one.
  const quartic smooth{1.0, 0.0, 1.0};
  const double coarse = follow(smooth, srkn6b{}, 0.24, on_line(1.0, 0.3), 1000, "").largest;
  const double fine = follow(smooth, srkn6b{}, 0.06, on_line(1.0, 0.3), 4000, "").largest;
  const double of_smooth = std::log(coarse / fine) / std::log(4.0);
  result.require(of_smooth > 3.5, fmt::format("in a smooth well srkn6b has the order {:.2f}", of_smooth));

  const auto check =
      check_force(system, {vector<double, 1>(-0.7), vector<double, 1>(0.4), vector<double, 1>(0.0)});
  result.note(fmt::format("check_force, at -0.7, 0.4 and the kink itself: {}", check.report()));
  result.show(
      {energy_panel("V = |q| from p = 0.55, 0.04 per evaluation", std::move(over_time)),
       {.title = "V = |q|, one crossing",
        .x_label = "step per evaluation",
        .y_label = "largest |H - H_0|",
        .log_log = true,
        .curves = std::move(over_step)}},
      "A kink takes from every method its order, and from some trajectories the bound too: that "
      "of the energy error is owed to smooth forces. Left, one on which every crossing meets the step at "
      "nearly the same phase, so that the errors add up, in Verlet's method as in others.",
      1560);
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
      const auto done = integrate(system, verlet{}, step, start, steps, look, 64);
      if (done.diverged_at) ++named;
      if (!done.diverged_at && std::abs(last) > 1.0) ++silent;
      if (done.diverged_at && done.diverged_at != first_bad_step(system, verlet{}, step, start, steps))
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
  const auto on_the_spot = integrate(system, verlet{}, 0.5, on_line(1.0, -1.75), 100).diverged_at;
  result.require(on_the_spot == 1,
                 "a step that lands on the centre itself, where the force is infinite: diverged at "
                 "step 1");
  const auto leaving = follow(system, verlet{}, 1e-2, on_line(1.0, 2.0), 100'000, "");
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
    const auto story = follow(steep, verlet{}, step, start, many, fmt::format("-q^4, h = {:g}", step));
    const auto expected = first_bad_step(steep, verlet{}, step, start, many);
    const double named_at = static_cast<double>(story.diverged_at.value_or(0)) * step;
    // Verlet conserves H + h^2 (p V'' p/12 - V'^2/24) = H - (8/3) h^2 q^6 here, so that H is off by 1000
    // where q^6 = 375/h^2, at end - t = 1/(sqrt 2 q); the next term is (h rate)^2 = 12 h^2 q^2 as large,
    // below 2 %, and that of the time a fifth of it.
    const double early = 1.0 / (std::numbers::sqrt2 * std::pow(375.0 / (step * step), 1.0 / 6.0));
    result.require(story.finite && story.diverged_at == expected &&
                       std::abs(named_at - (end - early)) <= 0.1 * early + step,
                   fmt::format("-q^4, h = {:g}: diverged at step {}, t = {:.5f}, expected {:.5f}; the motion "
                               "itself ends at {:.5f}",
                               step, story.diverged_at.value_or(-1), named_at, end - early, end));
    curves.push_back(story.shown);
  }
  const quartic cubic{1.0, -1.0, 0.0};  // a well with a pass of height 1/6 at q = 1
  for (const double speed : {0.9, 1.1}) {
    const auto thrown = on_line(0.0, speed * std::sqrt(1.0 / 3.0));
    const auto story =
        follow(cubic, verlet{}, 0.01, thrown, 100'000, fmt::format("cubic, {} of the pass", speed));
    const auto expected = first_bad_step(cubic, verlet{}, 0.01, thrown, 100'000);
    const bool stays = speed < 1.0;
    result.require(
        story.finite && story.diverged_at == expected && story.diverged_at.has_value() != stays,
        stays
            ? fmt::format("q^2/2 - q^3/3, thrown at 0.9 of the speed of the pass: stays, energy error {:.1e}",
                          story.largest)
            : fmt::format("at 1.1 of it: diverged at step {}", story.diverged_at.value_or(-1)));
    curves.push_back(story.shown);
  }
  result.show({energy_panel("No bottom", std::move(curves))}, "The energy error until the run is stopped.");
  return result;
}

}  // namespace

topic rough_potentials() {
  return {
      "Kinks, singularities and no bottom",
      {{"kink", "V = |q|, whose force jumps.",
        "One crossing changes the energy by some h |p|, whatever the order of the method. (That the error "
        "stays "
        "bounded need not hold: see the picture.)",
        "In a smooth well the same step sizes show the order 4 of srkn6b.", absolute_value},
       {"head_on", "A fall into the centre of -1/|q|.",
        "Whoever is off by a thousand times the energy is reported as diverged at that step; nothing "
        "that is shown is "
        "not finite.",
        "Thrown outwards nothing may be reported.", head_on},
       {"unbounded_below", "V = -q^4, whose motion ends at a finite time, and a cubic well with a pass.",
        "Reported as diverged at its step, as long before the exact end as Verlet is right; nothing that is "
        "shown is not finite.",
        "Below the pass nothing may diverge.", without_bottom}}};
}

}  // namespace nysalt::hard
