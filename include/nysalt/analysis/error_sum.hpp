// SPDX-License-Identifier: BSL-1.0
// The errors along trajectories side by side, added up.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>

#include "nysalt/analysis/error_measure.hpp"

namespace nysalt {

/// Result of a run: its score, or NaN and the step at which it diverged.
struct run_score {
  /// The contribution of the trajectory, see error_measure::score(); NaN if it diverged.
  double value = std::numeric_limits<double>::quiet_NaN();
  std::optional<std::int64_t> diverged_at = {};  ///< step of divergence, if any
};

/// The errors of one trajectory in each lane, added up in the order of time. None is kept.
template <class T>
class error_sum {
 public:
  using numbers = std::span<const T>;  ///< residuals of one state

  /// Refers to the measure. The start, where all errors are 0, may have a weight too.
  explicit error_sum(const error_measure& measure, double weight_of_start = 0.0)
      : measure_(&measure), weights_(weight_of_start) {}

  /// Adds the errors of sample i = 1, 2, ..., in this order, in the lanes that are live.
  void add(std::int64_t i, numbers seen, numbers reference, const condition_of<T>& live,
           double weight = 1.0) {
    sum_ = select(live, sum_ + measure_->error(seen, reference) * weight, sum_);
    weights_ += weight;
    lost_at_.take(both(!(sum_ - sum_ == T(0.0)), live), i);
  }

  /// The sum of the errors so far, in each lane.
  const T& sum() const { return sum_; }

  /// The score of lane k, which diverged where its state did, or where the error was no longer finite.
  run_score score(int k, std::optional<std::int64_t> diverged_at = {}) const {
    const auto lost_at = lost_at_[k];
    if (lost_at) return {.diverged_at = lost_at};
    if (diverged_at) return {.diverged_at = diverged_at};
    return {.value = measure_->score(lane(sum_, k), weights_)};
  }

 private:
  const error_measure* measure_;
  double weights_;
  T sum_{0.0};
  first_in_lanes<T> lost_at_{};
};

}  // namespace nysalt
