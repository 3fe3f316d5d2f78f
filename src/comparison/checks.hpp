// SPDX-License-Identifier: BSL-1.0
// Checks of numbers that all commands share.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "nysalt/core/steps_in.hpp"
#include "refusal.hpp"
#include "seeds.hpp"
#include "settings.hpp"

namespace nysalt::program {

inline void require_sound(const common_settings& common) {
  constexpr int most_threads = 1024;  // each takes memory, before it works
  if (common.execution.threads < 1 || common.execution.threads > most_threads) {
    refuse_value("threads", "must be at least 1 and at most {}, got {}", most_threads,
                 common.execution.threads);
  }
  if (common.seed >= seed_limit)
    refuse_value("seed", "must be below 2^51 = {}, got {}", seed_limit, common.seed);
}

/// Subnormal numbers, of fewer digits, are too small.
inline void require_positive(const std::string& field, double value) {
  constexpr double least = std::numeric_limits<double>::min();
  if (value >= least && std::isfinite(value)) return;
  if (value > 0.0 && value < least) refuse_value(field, "must be at least {:.3g}, got {}", least, value);
  refuse_value(field, "must be a positive, finite number, got {}", value);
}

inline void require_at_least_one(const std::string& field, std::int64_t value) {
  if (value < 1) refuse_value(field, "must be at least 1, got {}", value);
}

/// Throws refusal if two of the values are the same, `same` of neighbours in increasing order.
template <class T, class Same = std::ranges::equal_to>
void require_different(const std::string& field, std::vector<T> values, const Same& same = {}) {
  std::ranges::sort(values);
  const auto twice = std::ranges::adjacent_find(values, same);
  if (twice != values.end()) refuse_value(field, "must be different, got {} twice; give each once", *twice);
}

/// Throws refusal if the square of the highest frequency of `system` overflows, or has fewer digits than
/// others.
inline void require_square_of_frequency(const std::string& system, double frequency) {
  const double square = frequency * frequency;
  if (std::isfinite(square) && (frequency == 0.0 || square >= std::numeric_limits<double>::min())) return;
  refuse("{}: the highest frequency must have a square of full precision, got {}; take other parameters",
         system, frequency);
}

/// steps_in(). Throws refusal if that is no step, or more than can be counted.
inline std::int64_t steps_within(const std::string& field, double horizon, double step) {
  require_positive(field, horizon);
  const double steps = nysalt::detail::steps_in(horizon, step);
  if (steps < 1.0) refuse_value(field, "must be at least one step of {}, got {}", step, horizon);
  if (!(steps < 0x1p53)) refuse_value(field, "must hold fewer than 2^53 steps of {}, got {}", step, horizon);
  return static_cast<std::int64_t>(steps);
}

/// Steps to the horizon or just beyond it, and at least one: errors are means over all of it.
inline std::int64_t steps_beyond(const std::string& field, double horizon, double step) {
  const std::int64_t whole = steps_within(field, horizon, step);
  const double ratio = horizon / step;
  return whole + (static_cast<double>(whole) < ratio - nysalt::detail::rounding_of_steps(ratio) ? 1 : 0);
}

/// The least number of samples in a mean over time: the trapezoidal rule errs then by half a percent of a
/// square error that grows like t^2 (sample_weights).
inline constexpr double fewest_samples = 10.0;

}  // namespace nysalt::program
