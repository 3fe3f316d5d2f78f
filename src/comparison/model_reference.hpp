// SPDX-License-Identifier: BSL-1.0
// References of bundled systems: the exact flow, or small steps, in a bath along paths.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "nysalt/methods/classical.hpp"
#include "nysalt/references/fine_steps.hpp"
#include "refusal.hpp"

namespace nysalt::program {

/// A fine step that divides the step, and each of `parts` equal parts of the step: the one that was asked
/// for, or the largest below `most`. Throws refusal where it does not divide.
inline double fine_step_within(double step, std::optional<double> asked, double most, int parts = 1) {
  const double least = std::ceil(step / most - 1e-9);  // 100.00000000000001 is 100
  const double fine = asked.value_or(step / (parts * std::max(1.0, std::ceil(least / parts))));
  const double ratio = step / fine / parts;
  if (!(std::round(ratio) >= 1.0) || !(std::abs(ratio - std::round(ratio)) <= 1e-9 * ratio)) {
    const std::string part =
        parts == 1 ? "" : fmt::format(" in {} equal parts, as its letters O need it", parts);
    refuse_value("fine_step", "must divide the step {}{}, got {}", step, part, fine);
  }
  constexpr double too_many = 1e6;  // a million for one step: the program would seem to hang
  if (ratio * parts > too_many) {
    refuse("the step {} must hold at most {:g} fine steps, got {:g} of {:g}; take a {}", step, too_many,
           ratio * parts, fine, asked ? "larger " + spelled("fine_step") : "smaller step");
  }
  return fine;
}

/// The method of small steps: in a bath BAOAB, else of order 6, SRKN11b where the kinetic energy is
/// quadratic.
inline method method_of_reference(const model& system) {
  if (system.bath().acts()) return method(baoab{});
  return has_quadratic_kinetic(system) ? method(srkn11b{}) : method(blanes_moan_s10{});
}

/// Of a system with frequencies up to `frequency`, or of none that is known, 0; a fine step goes through
/// `angle` of the fastest motion.
class model_reference {
 public:
  model_reference(const model& system, double frequency, double angle, bool has_exact_flow,
                  std::optional<reference> exact)
      : method_(method_of_reference(system)),
        bath_(&system.bath()),
        frequency_(frequency),
        angle_(angle),
        has_exact_flow_(has_exact_flow),
        exact_(std::move(exact)) {}

  /// The step of the reference at a step whose noise is wanted in parts; nothing where the flow is known
  /// exactly. The error of order 6 is rounding then. BAOAB errs along a noisy path to first order in the
  /// step: where nothing is stiff, a hundredth of what is learned (detail::objection) takes finer steps than
  /// frequencies suggest.
  std::optional<double> fine_step(double step, std::optional<double> asked, int parts) const {
    if (is_exact() && !asked) return std::nullopt;
    const double few = step / usual_steps;
    const double most = longest(step, angle_);
    return fine_step_within(step, asked, bath_->acts() ? std::min(most, few) : most, std::max(parts, 1));
  }

  reference at(double step, std::optional<double> asked, int parts) const {
    const auto fine = fine_step(step, asked, parts);
    if (!fine) return exact_.value();
    return bath_->acts() ? fine_paths(*fine, method_) : fine_steps(*fine, method_);
  }

  /// To rank methods by errors far above rounding: order 6 at ten times the step leaves little more, and what
  /// it leaves is measured. Nothing where the usual one is wanted.
  std::optional<double> fine_step_for_ranking(double step) const {
    if (is_exact() || bath_->acts()) return std::nullopt;
    constexpr double angle = 0.05;
    return fine_step_within(step, {}, longest(step, angle));
  }

  /// For statistics only: their bias by BAOAB is of second order, and the floor of sampling is high. A tenth
  /// of the step at most, or a small step would be compared with itself.
  double fine_step_for_statistics(double step, std::optional<double> asked) const {
    constexpr double angle = 0.05;
    return fine_step_within(step, asked, std::min(longest(step, angle), 0.1 * step));
  }

  double fastest() const { return std::max(frequency_, bath_->friction()); }

 private:
  bool is_exact() const { return has_exact_flow_ && !bath_->acts(); }

  static constexpr double usual_steps = 200.0;  // in a step, as in the paper in a bath at the step .02

  /// The fine step by its angle. Where nothing is known of the motion, of a step of `usual_steps`, and of
  /// fewer for a larger angle: what they err by is measured.
  double longest(double step, double angle) const {
    constexpr double usual = 5e-3;
    return fastest() > 0.0 ? angle / fastest() : step / usual_steps * std::max(1.0, angle / usual);
  }

  method method_;
  const bath* bath_;
  double frequency_;
  double angle_;
  bool has_exact_flow_;
  std::optional<reference> exact_;
};

}  // namespace nysalt::program
