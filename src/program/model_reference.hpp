// SPDX-License-Identifier: BSL-1.0
// What a bundled system is compared with: its exact flow, or small steps, in a bath along paths.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "chosen_reference.hpp"
#include "nysalt/systems/in_bath.hpp"
#include "refusal.hpp"

namespace nysalt::program {

/// A fine step that divides the step, and each of so many equal parts of it: the one that was asked for, or
/// the largest below `most`. Throws refusal where it does not divide.
inline double fine_step_within(double step, std::optional<double> asked, double most, int parts = 1) {
  const double least = std::ceil(step / most - 1e-9);  // 100.00000000000001 is 100
  const double fine = asked.value_or(step / (parts * std::max(1.0, std::ceil(least / parts))));
  const double ratio = step / fine / parts;
  if (!(std::round(ratio) >= 1.0) || !(std::abs(ratio - std::round(ratio)) <= 1e-9 * ratio)) {
    const std::string part =
        parts == 1 ? "" : fmt::format(" in {} equal parts, as its letters O need it,", parts);
    refuse(
        "the step {}{} is not an integer multiple of the fine step {}: choose a --fine-step that divides it",
        step, part, fine);
  }
  constexpr double too_many = 1e6;  // a million for one step: the program would seem to hang
  if (ratio * parts > too_many) {
    refuse("the step {} holds {:g} fine steps of {:g}, more than {:g}: take a larger --fine-step", step,
           ratio * parts, fine, too_many);
  }
  return fine;
}

/// Of a system with frequencies up to `frequency`; a fine step goes through `angle` of the fastest motion.
template <class S>
class model_reference {
 public:
  model_reference(const in_bath<S>& system, double frequency, double angle)
      : system_(&system), frequency_(frequency), angle_(angle) {}

  /// That of the reference at a step whose noise is wanted in parts; nothing where the flow is known exactly.
  /// The error of srkn11b is rounding then. BAOAB errs along a noisy path to first order in the step: where
  /// nothing is stiff, a hundredth of what is learned (detail::objection) takes more than frequencies tell.
  std::optional<double> fine_step(double step, std::optional<double> asked, int parts) const {
    if (is_exact() && !asked) return std::nullopt;
    constexpr double fine_steps_in_bath = 200.0;  // as in the paper, at its step .02
    const double most = angle_ / fastest();
    const bool is_noisy = system_->bath().acts();
    return fine_step_within(step, asked, is_noisy ? std::min(most, step / fine_steps_in_bath) : most,
                            std::max(parts, 1));
  }

  chosen_reference<S> at(double step, std::optional<double> asked, int parts) const {
    const auto fine = fine_step(step, asked, parts);
    if (system_->bath().acts()) return chosen_reference<S>(fine_paths<>(*fine));
    if constexpr (has_exact_flow<S>) {
      if (!fine) return chosen_reference<S>(exact_linear(*system_));
    }
    return chosen_reference<S>(fine_steps<>(*fine));
  }

  /// To rank methods by errors far above rounding: srkn11b at ten times the step leaves little more, and what
  /// it leaves is measured. Nothing where the usual one is wanted.
  std::optional<double> fine_step_for_ranking(double step) const {
    if (is_exact() || system_->bath().acts()) return std::nullopt;
    constexpr double angle = 0.05;
    return fine_step_within(step, {}, angle / fastest());
  }

  /// For statistics alone: their bias by BAOAB is of second order, and the floor of sampling is high. A tenth
  /// of the step at most, or a small step would be compared with itself.
  double fine_step_for_statistics(double step, std::optional<double> asked) const {
    constexpr double angle = 0.05;
    return fine_step_within(step, asked, std::min(angle / fastest(), 0.1 * step));
  }

  double fastest() const { return std::max(frequency_, system_->bath().friction()); }

 private:
  bool is_exact() const { return has_exact_flow<S> && !system_->bath().acts(); }

  const in_bath<S>* system_;
  double frequency_;
  double angle_;
};

}  // namespace nysalt::program
