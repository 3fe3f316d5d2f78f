// SPDX-License-Identifier: BSL-1.0
// The energy error along a trajectory, as a curve and as what is asked of it.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "../../../src/report/figure.hpp"
#include "nysalt/integrate.hpp"
#include "nysalt/method.hpp"

namespace nysalt::hard {

/// The relative error of the energy, |H - H_0|/|H_0|, or |H - H_0| where H_0 is 0 but for rounding.
struct energy_story {
  curve shown;           // its largest value within intervals of time that grow by a quarter
  double largest = 0.0;  // in all that was seen
  double early = 0.0;    // in the first half of the time
  double late = 0.0;     // in the second
  double last = 0.0;
  bool finite = true;  // all states that were seen
  std::optional<std::int64_t> diverged_at;

  /// Bounded, to all appearance: a trend doubles the error, a random walk multiplies it by 1.41.
  bool has_no_trend() const { return finite && !diverged_at && late <= 1.4 * early; }
};

/// Takes in energies in the order of time.
class energy_watch {
 public:
  energy_watch(double initial, double end) : initial_(initial), half_(0.5 * end) {}

  void see(double t, double energy) {
    const double unit = std::abs(initial_) < 1e-12 ? 1.0 : std::abs(initial_);
    const double error = std::abs(energy - initial_) / unit;
    story_.finite = story_.finite && std::isfinite(error);
    story_.largest = std::max(story_.largest, error);
    double& of_half = t <= half_ ? story_.early : story_.late;
    of_half = std::max(of_half, error);
    story_.last = error;
    if (t == 0.0) return;
    if (edge_ == 0.0) edge_ = t;
    in_interval_ = std::max(in_interval_, error);
    if (t < edge_) return;
    add_point(t);
    while (edge_ <= t) edge_ *= 1.25;
  }

  energy_story told(std::string label, bool learned = false) {
    story_.shown.label = std::move(label);
    story_.shown.emphasised = learned;
    return std::move(story_);
  }

 private:
  void add_point(double t) {
    story_.shown.x.push_back(t);
    story_.shown.y.push_back(std::max(in_interval_, 1e-17));  // the axis is logarithmic
    in_interval_ = 0.0;
  }

  double initial_;
  double half_;
  double edge_ = 0.0;
  double in_interval_ = 0.0;
  energy_story story_;
};

/// Follows a trajectory by integrate(), and looks at the energy every so many steps.
template <HasEnergy S>
energy_story follow(const S& system, const method& method, double step,
                    const phase_point<double, S::dimension>& start, std::int64_t steps, std::string label,
                    bool learned = false, std::int64_t every = 1) {
  energy_watch watch(energy<double>(system, start), static_cast<double>(steps) * step);
  const auto look = [&](std::int64_t, double t, const auto& x) { watch.see(t, energy<double>(system, x)); };
  const auto diverged_at = integrate(system, method, step, start, steps, look, every).diverged_at;
  energy_story story = watch.told(std::move(label), learned);
  story.diverged_at = diverged_at;
  return story;
}

/// The first step whose state is not finite or has |H - H_0| > 1e3 max(|H_0|, 1): what integrate() must name,
/// looked for one step after the other.
template <HasEnergy S>
std::optional<std::int64_t> first_bad_step(const S& system, const method& method, double step,
                                           const phase_point<double, S::dimension>& start,
                                           std::int64_t steps) {
  const auto stepper = make_stepper(system, method, step);
  const double initial = energy<double>(system, start);
  auto run = stepper.open(start);
  while (run.step < steps) {
    stepper.advance(run, 1);
    const auto x = stepper.synchronous(run);
    const double off = std::abs(energy<double>(system, x) - initial);
    if (!is_finite(x) || !(off <= 1e3 * std::max(std::abs(initial), 1.0))) return run.step;
  }
  return std::nullopt;
}

/// A method with its step. At equal cost all steps are one number times the evaluations of a step.
struct contender {
  std::string label;
  nysalt::method method;
  bool learned = false;

  double step(double per_evaluation) const {
    return per_evaluation * static_cast<double>(method.letters().evaluations_per_step);
  }
};

/// Follows a contender over a time, at a step per evaluation.
template <HasEnergy S>
energy_story follow(const S& system, const contender& compared, double per_evaluation,
                    const phase_point<double, S::dimension>& start, double time) {
  const double step = compared.step(per_evaluation);
  return follow(system, compared.method, step, start, std::llround(time / step), compared.label,
                compared.learned);
}

/// One panel of energy errors over time.
inline panel energy_panel(std::string title, std::vector<curve> curves) {
  return {.title = std::move(title),
          .x_label = "time",
          .y_label = "largest |H - H_0|/|H_0| so late",
          .log_log = true,
          .curves = std::move(curves)};
}

}  // namespace nysalt::hard
