// SPDX-License-Identifier: BSL-1.0
// Methods beside the reference, along trajectories side by side.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <stdexcept>
#include <vector>

#include "nysalt/analysis/error_along.hpp"
#include "nysalt/lockstep.hpp"

namespace nysalt {

/// Methods of one type beside the reference, from the same starts; one trajectory in each lane.
template <class Stepper, SeparableSystem S, ReferenceFlow<S> R>
class compared_block {
 public:
  using measure_type = error_measure<S::dimension, lanes_of<S>>;
  using T = typename measure_type::T;
  using state = phase_point<T, S::dimension>;
  using errors_type = error_sum<S::dimension, lanes_of<S>>;

  /// Refers to all but the start, and partly to itself.
  compared_block(const S& system, const R& reference, const std::vector<Stepper>& steppers,
                 const measure_type& measure, const state& start, int count, int to_check)
      : measure_(&measure), at_start_(measure.numbers_of(start)), live_(first_lanes<T>(count)) {
    if (measure.needs_reference) reference_.emplace(system, reference, measure, start, count);
    if (measure.needs_reference && to_check > 0) {
      its_finer_self_.emplace(reference.finer());
      finer_.emplace(system, *its_finer_self_, measure, start, to_check);
      check_.emplace(measure);
    }
    for (const auto& stepper : steppers) runs_.push_back({{stepper, start, count}, errors_type(measure)});
    if (!measure.needs_reference && measure.scale) require_scale(count);
  }

  compared_block(const compared_block&) = delete;
  compared_block& operator=(const compared_block&) = delete;

  /// All of them, a stretch after the other, so that no path is kept.
  void run(double step, std::int64_t steps) {
    for (std::int64_t done = 0; done < steps; done += steps_between_checks) {
      const std::int64_t next = std::min(done + steps_between_checks, steps);
      if (reference_) reference_->go_on(step, next - done);
      if (finer_) finer_->go_on(step, next - done);
      const auto expected = [&](std::int64_t n) {
        return reference_ ? reference_->at(n - done - 1) : std::span<const T>(at_start_);
      };
      for (std::int64_t n = done + 1; finer_ && n <= next; ++n) {
        check_->add(n, expected(n), finer_->at(n - done - 1), live_);
      }
      for (watched_run& its : runs_) {
        its.run.go_on(next, 1, measure_->width, measure_->read,
                      [&](std::int64_t n, std::span<const T> seen, const auto& live) {
                        its.errors.add(n, seen, expected(n), live);
                      });
      }
    }
  }

  void require_sound(std::int64_t first) const {
    if (reference_) reference_->require_sound(first);
    if (finer_) finer_->require_sound(first);
  }
  run_score score(std::size_t method, int k) const {
    return runs_[method].errors.score(k, runs_[method].run.diverged_at(k));
  }
  double check(int k) const { return check_->score(k).value; }

 private:
  struct watched_run {
    lockstep<Stepper, T> run;
    errors_type errors;
  };

  void require_scale(int count) const {
    const T scale = measure_->scale(at_start_);
    for (int k = 0; k < count; ++k) {
      if (lane(scale, k) == 0.0) throw std::invalid_argument(measure_->no_scale);
    }
  }

  const measure_type* measure_;
  std::vector<T> at_start_;
  condition_of<T> live_;
  std::optional<reference_along<S, R>> reference_;
  std::optional<R> its_finer_self_;
  std::optional<reference_along<S, R>> finer_;
  std::optional<errors_type> check_;  // of the reference against its finer self
  std::vector<watched_run> runs_;
};

}  // namespace nysalt
