// SPDX-License-Identifier: BSL-1.0
// A measure along one trajectory: what it reads of the reference, and a method against that as it runs.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <stdexcept>
#include <vector>

#include "nysalt/analysis/error_measure.hpp"
#include "nysalt/integrate.hpp"
#include "nysalt/reference.hpp"

namespace nysalt {

/// What a measure reads along a reference at t_i = i step, i = 1..steps, `width` numbers a sample.
/// Throws std::runtime_error if the reference, or a number, is not finite; `trajectory` names it then.
template <SeparableSystem S, ReferenceFlow<S> R>
std::vector<double> reference_numbers(const S& system, const R& reference, double step, std::int64_t steps,
                                      phase_point<double, S::dimension> x,
                                      const error_measure<S::dimension>& measure, std::int64_t trajectory) {
  std::vector<double> result(static_cast<std::size_t>(steps) * measure.width);
  for (std::int64_t n = 0; n < steps; ++n) {
    reference.advance(system, x, step);
    const auto here = std::span(result).subspan(static_cast<std::size_t>(n) * measure.width, measure.width);
    measure.read(x, here);
    if (is_finite(x) && std::all_of(here.begin(), here.end(), [](double y) { return std::isfinite(y); })) {
      continue;
    }
    throw std::runtime_error(fmt::format(
        "trajectory {} of the reference ({}), or what the {} error reads of it, is not finite at step {}; "
        "take other starts, a finer reference or a shorter horizon",
        trajectory, reference.description(), measure.name, n + 1));
  }
  return result;
}

/// The errors of one trajectory, added up in the order of time. None is kept.
template <int N>
class error_sum {
 public:
  using numbers = std::span<const double>;

  /// Refers to all of them. `expected` is empty if the measure needs no reference.
  error_sum(const error_measure<N>& measure, numbers expected, numbers at_start)
      : measure_(&measure), expected_(expected), at_start_(at_start) {}

  /// Sample i = 1, 2, ..., in this order.
  void add(std::int64_t i, numbers seen) {
    const std::size_t first = static_cast<std::size_t>(i - 1) * seen.size();
    const numbers there = expected_.empty() ? expected_ : expected_.subspan(first, seen.size());
    sum_ += measure_->error(seen, there, at_start_);
    samples_ += 1.0;
    if (!std::isfinite(sum_) && !lost_at_) lost_at_ = i;
  }

  double score() const { return measure_->score(sum_, samples_); }
  /// The first sample at which the sum was not finite, if there was one.
  std::optional<std::int64_t> lost_at() const { return lost_at_; }

 private:
  const error_measure<N>* measure_;
  numbers expected_;
  numbers at_start_;
  double sum_ = 0.0;
  double samples_ = 0.0;
  std::optional<std::int64_t> lost_at_;
};

/// What is left of a run: its score, or NaN and the step at which it diverged.
struct run_score {
  double value = std::numeric_limits<double>::quiet_NaN();
  std::optional<std::int64_t> diverged_at = {};
};

/// Takes `steps` steps from start and compares on the way; no path is stored. An error that is not finite is
/// a divergence at its step, like a state that is not.
template <class Stepper, int N>
run_score score_of_run(const Stepper& stepper, const phase_point<double, N>& start, std::int64_t steps,
                       const error_measure<N>& measure, error_sum<N> errors) {
  std::vector<double> seen(measure.width);
  const auto compare = [&](std::int64_t n, double, const auto& x) {
    if (n == 0) return;
    measure.read(x, seen);
    errors.add(n, seen);
  };
  const auto end = integrate(stepper, start, steps, compare, 1);
  const auto diverged_at = errors.lost_at() ? errors.lost_at() : end.diverged_at;
  if (diverged_at) return {.diverged_at = diverged_at};
  return {.value = errors.score()};
}

/// The same for the numbers of a path that was kept.
template <int N>
double score_of_path(std::span<const double> path, const error_measure<N>& measure, error_sum<N> errors) {
  for (std::size_t n = 0; n * measure.width < path.size(); ++n) {
    errors.add(static_cast<std::int64_t>(n + 1), path.subspan(n * measure.width, measure.width));
  }
  return errors.score();
}

}  // namespace nysalt
