// SPDX-License-Identifier: BSL-1.0
// Whether a word may be used at a step: it must be stable on the frequencies that the system has.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <ranges>
#include <string>
#include <type_traits>
#include <vector>

#include "nysalt/conservative_part.hpp"
#include "nysalt/derivatives/linear_stability.hpp"
#include "nysalt/derivatives/magnification.hpp"
#include "nysalt/derivatives/stiffness_along.hpp"
#include "nysalt/derivatives/word_on_oscillator.hpp"
#include "nysalt/quadratic_part.hpp"
#include "nysalt/served_letters.hpp"

namespace nysalt {

/// Knows the frequencies of a system: those of its frequency_bands(), or, where it declares none and its
/// kinetic energy is quadratic, all from 0 to the highest along some states; 2 % more on either side. Outside
/// of them a word may be unstable: gaps() tells where. Words with rotations are stable on the quadratic part
/// at any step. They are asked how much they magnify each of its modes under soft forces of any positive
/// stiffness up to the largest along the states.
class stability_guard {
 public:
  /// Words with rotations, if there will be some, are watched over so many steps, if there are states. Cost:
  /// that of stiffness_along() where no bands are declared, and where a quadratic part is. Throws what that
  /// does.
  template <SeparableSystem S>
  stability_guard(const S& system, const std::ranges::range auto& states, bool rotations = true,
                  std::int64_t steps = 10'000)
      : steps_(steps) {
    declare_bands(system);
    if (!bands_.empty()) {
      description_ = "declared bands";
      for (const auto& band : bands_) description_ += fmt::format(" [{:g}, {:g}]", band.low, band.high);
    } else if constexpr (NystromSystem<S>) {
      const auto found = stiffness_along(system, states);
      bands_.push_back({0.0, found.highest_frequency() * (1.0 + margin)});
      description_ = fmt::format("estimated 0..{:.4g} along {} states", bands_[0].high, found.states);
    } else {
      description_ = "no guard: no bands are declared, and the kinetic energy is not quadratic";
    }
    if constexpr (HasQuadraticPart<S> && ForceDerivativeOver<S, double, field::soft>) {
      if (!rotations || std::ranges::empty(states)) return;
      const auto part = quadratic_part::of(system);
      for (const double omega : part->frequencies()) add_mode(omega);
      const double highest = stiffness_along<field::soft>(system, states).highest_frequency();
      stiffest_soft_ = highest * (1.0 + margin);
      description_ += fmt::format("; {} modes under soft forces of frequencies up to {:.4g}", modes_.size(),
                                  stiffest_soft_);
    }
  }

  /// Whether there is no objection() to the word with these coefficients at this step.
  bool admits(const run_time_word& word, const std::vector<double>& coefficients, double step) const {
    return objection(word, coefficients, step).empty();
  }

  /// One sentence, or nothing if the word may be used. Cost: some 5 us for 9 evaluations; with rotations some
  /// 20 us a mode.
  /// Throws std::invalid_argument unless there is a coefficient for each slot.
  std::string objection(const run_time_word& word, const std::vector<double>& coefficients,
                        double step) const {
    word.require_one_for_each_slot(coefficients);
    return rotates(word) ? magnified(word, coefficients, step) : unstable(word, coefficients, step);
  }

  /// Where z = step omega is unstable between 0 and the system's highest frequency: outside its bands, if the
  /// word is admitted. None for words with rotations. Cost: that of stability_windows().
  std::vector<stability_window> gaps(const run_time_word& word, const std::vector<double>& coefficients,
                                     double step) const {
    if (rotates(word)) return {};
    double highest = 0.0;
    for (const auto& band : bands_) highest = std::max(highest, step * band.high);
    return gaps_below(stability_windows(conservative_part(word), conservative_part(word, coefficients)),
                      highest);
  }

  /// A mode, and how much it grows.
  struct magnified_mode {
    double frequency;  ///< omega
    double factor;     ///< largest |M^n|, see magnification()
  };
  /// The mode that a word with rotations magnifies most, or the first that it magnifies by more than is
  /// `enough`. Factor 1 where no modes are known. Cost: some 20 us a mode.
  magnified_mode most_magnified(const run_time_word& word, const std::vector<double>& coefficients,
                                double step, double enough = std::numeric_limits<double>::infinity()) const {
    constexpr int samples = 64;  // a narrower gap is passed before it does harm, as soft forces change
    magnified_mode worst{0.0, 1.0};
    for (const double omega : modes_) {
      for (int i = 1; i <= samples && stiffest_soft_ > 0.0; ++i) {
        const double soft = step * stiffest_soft_ * i / samples;
        const double grown = magnification(word, coefficients, step * omega, soft * soft, steps_);
        if (!(grown <= worst.factor)) worst = {omega, grown};
        if (!(worst.factor <= enough)) return worst;
      }
    }
    return worst;
  }

  const std::vector<frequency_band>& frequencies() const { return bands_; }  ///< with 2 % more on either side
  /// Frequencies on which words with rotations are watched: none, or those of the quadratic part.
  const std::vector<double>& modes() const { return modes_; }
  /// Number of steps over which words with rotations are watched.
  std::int64_t steps() const { return steps_; }
  const std::string& description() const { return description_; }  ///< what it knows, and where from

 private:
  static constexpr double margin = 0.02;

  static bool rotates(const run_time_word& word) { return has_rotation(word) || word.reads == field::soft; }

  void declare_bands(const auto& system) {
    if constexpr (HasFrequencyBands<std::remove_cvref_t<decltype(system)>>) {
      for (const auto& band : system.frequency_bands())
        bands_.push_back({band.low * (1.0 - margin), band.high * (1.0 + margin)});
    }
  }
  /// Modes that a decomposition found equal but for rounding are one.
  void add_mode(double omega) {
    const auto is_near = [&](double other) { return std::abs(omega - other) <= 1e-9 * other; };
    if (std::none_of(modes_.begin(), modes_.end(), is_near)) modes_.push_back(omega);
  }

  std::string unstable(const run_time_word& word, const std::vector<double>& coefficients,
                       double step) const {
    constexpr double rounding = 1e-10;  // where it is more it takes 1/sqrt(2e-10) = 70,000 steps to grow by e
    for (const auto& band : bands_) {
      const double low = step * band.low;
      const double high = step * band.high;
      const auto trace = half_trace(word, coefficients, 0.0, low * low, high * high);
      if (const auto x = where_larger(trace, 1.0 + rounding)) {
        return fmt::format(
            "it is not linearly stable at z = {:.4g}, on the frequencies {:.4g} to {:.4g} of the system",
            std::sqrt(*x), band.low, band.high);
      }
    }
    return {};
  }

  /// Threefold is much: a stable motion whose energy swings by nine. On the FPU chain at h omega = j pi
  /// impulses come to 33 by t = 100, and words learned there to 1.0003.
  std::string magnified(const run_time_word& word, const std::vector<double>& coefficients,
                        double step) const {
    constexpr double too_much = 3.0;
    const auto worst = most_magnified(word, coefficients, step, too_much);
    if (worst.factor <= too_much) return {};
    return fmt::format(
        "in {} steps it magnifies the mode of frequency {:.4g}, z = {:.4g}, {:.3g}-fold under soft forces",
        steps_, worst.frequency, step * worst.frequency, worst.factor);
  }

  std::vector<frequency_band> bands_;
  std::vector<double> modes_;
  double stiffest_soft_ = 0.0;
  std::int64_t steps_;
  std::string description_;
};

}  // namespace nysalt
