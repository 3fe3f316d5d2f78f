// SPDX-License-Identifier: BSL-1.0
// Whether a word may be used at a step: it must be stable on the frequencies that the system has.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "nysalt/conservative_part.hpp"
#include "nysalt/derivatives/linear_stability.hpp"
#include "nysalt/derivatives/stiffness_along.hpp"
#include "nysalt/derivatives/word_on_oscillator.hpp"

namespace nysalt {

/// Knows the frequencies of a system: those of its frequency_bands(), or, where it declares none and its
/// kinetic energy is quadratic, all from 0 to the highest along some states; 2 % more on either side. Outside
/// of them a word may be unstable: gaps() tells where.
class stability_guard {
 public:
  /// The states are looked at only where the system does not say enough by itself. A word with rotations is
  /// watched over so many steps. Cost: that of stiffness_along().
  template <SeparableSystem S>
  stability_guard(const S& system, const std::ranges::range auto& states, std::int64_t steps = 10'000)
      : steps_(steps) {
    if constexpr (HasFrequencyBands<S>) {
      for (const auto& band : system.frequency_bands())
        bands_.push_back({band.low * (1.0 - margin), band.high * (1.0 + margin)});
      description_ = "declared bands";
      for (const auto& band : bands_) description_ += fmt::format(" [{:g}, {:g}]", band.low, band.high);
    } else if constexpr (NystromSystem<S>) {
      const auto found = stiffness_along(system, states);
      bands_.push_back({0.0, found.highest_frequency() * (1.0 + margin)});
      description_ = fmt::format("estimated 0..{:g} along {} states", bands_[0].high, found.states);
    } else {
      description_ = "no guard: no bands are declared, and the kinetic energy is not quadratic";
    }
  }

  bool admits(const run_time_word& word, const std::vector<double>& coefficients, double step) const {
    return objection(word, coefficients, step).empty();
  }

  /// One sentence, or nothing if the word is stable. Cost: some 10 us for 9 evaluations.
  /// Throws std::invalid_argument unless there is a coefficient for each slot.
  std::string objection(const run_time_word& word, const std::vector<double>& coefficients,
                        double step) const {
    word.require_one_for_each_slot(coefficients);
    for (const auto& band : bands_) {
      const auto square = [&](double omega) { return step * step * omega * omega; };
      const auto trace = half_trace(word, coefficients, 0.0, square(band.low), square(band.high));
      if (const auto x = where_larger(trace, 1.0 + rounding)) {
        return fmt::format("it is unstable at z = {:.4g}, within the frequencies {:g} to {:g} ({})",
                           std::sqrt(*x), band.low, band.high, description_);
      }
    }
    return {};
  }

  /// Where z = step omega is unstable between 0 and the system's highest frequency: outside its bands, if the
  /// word is admitted. Cost: that of stability_windows().
  std::vector<stability_window> gaps(const run_time_word& word, const std::vector<double>& coefficients,
                                     double step) const {
    double highest = 0.0;
    for (const auto& band : bands_) highest = std::max(highest, step * band.high);
    std::vector<stability_window> result;
    double last = 0.0;
    for (const auto& window :
         stability_windows(conservative_part(word), conservative_part(word, coefficients))) {
      if (last < std::min(window.low, highest)) result.push_back({last, std::min(window.low, highest)});
      last = window.high;
    }
    if (last < highest) result.push_back({last, highest});
    return result;
  }

  const std::vector<frequency_band>& frequencies() const { return bands_; }
  const std::string& description() const { return description_; }

 private:
  static constexpr double margin = 0.02;
  static constexpr double rounding = 1e-10;  // grows by e in 1/sqrt(2e-10) = 70,000 steps, where at all

  std::vector<frequency_band> bands_;
  std::int64_t steps_;
  std::string description_;
};

}  // namespace nysalt
