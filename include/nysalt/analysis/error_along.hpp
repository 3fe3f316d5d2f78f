// SPDX-License-Identifier: BSL-1.0
// A measure along trajectories side by side: what it reads of the reference, and the errors added up.
#pragma once

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <stdexcept>
#include <vector>

#include "nysalt/analysis/error_measure.hpp"
#include "nysalt/noises/recorded_path.hpp"
#include "nysalt/reference.hpp"

namespace nysalt {

/// What a measure reads along a reference, a stretch of samples at a time; one trajectory in each lane. In a
/// bath the noise of that stretch is kept for those who follow.
template <SeparableSystem S, Reference<S> R>
class reference_along {
 public:
  using measure_type = error_measure<S::dimension, lanes_of<S>>;
  using T = typename measure_type::T;
  using state = phase_point<T, S::dimension>;
  using path_type = recorded_path<T, S::dimension>;

  /// Refers to system, reference, measure and path. `count` lanes hold a trajectory, that in lane 0 is the
  /// place's. The noise of each step is added to the path in so many parts.
  reference_along(const S& system, const R& reference, const measure_type& measure, const state& start,
                  int count, const path_place& at = {}, path_type* path = nullptr, int noise_parts = 0)
      : system_(&system),
        reference_(&reference),
        measure_(&measure),
        x_(start),
        count_(count),
        at_(at),
        path_(path),
        noise_(static_cast<std::size_t>(noise_parts), make_vector<T>(system)) {}

  /// The next `samples` of them, each a time `step` after the last. What is not sound is remembered.
  void go_on(double step, std::int64_t samples) {
    numbers_.resize(static_cast<std::size_t>(samples) * measure_->width);
    // A letter O that ends the step before the stretch is still to come.
    if (path_ != nullptr) path_->forget_before((at_.step - 1) * std::ssize(noise_));
    for (std::int64_t i = 0; i < samples; ++i) {
      advance_lanes(*system_, *reference_, x_, step, count_, at_, std::span(noise_));
      for (const auto& xi : noise_) path_->add(xi);
      ++at_.step;
      const auto here =
          std::span(numbers_).subspan(static_cast<std::size_t>(i) * measure_->width, measure_->width);
      measure_->read(x_, here);
      inspect(here);
    }
  }

  /// Sample i of the last stretch.
  std::span<const T> at(std::int64_t i) const {
    return std::span(numbers_).subspan(static_cast<std::size_t>(i) * measure_->width, measure_->width);
  }

  /// Throws for the first trajectory that came to grief: std::runtime_error where the reference, or what is
  /// read of it, is not finite; std::invalid_argument where the measure has no scale. `first` is in lane 0.
  void require_sound(std::int64_t first) const {
    for (int k = 0; k < count_; ++k) {
      const auto& its = failures_[static_cast<std::size_t>(k)];
      if (!its) continue;
      if (its->without_scale) throw std::invalid_argument(measure_->no_scale);
      throw std::runtime_error(fmt::format(
          "trajectory {} of the reference ({}), or what the {} error reads of it, is not finite at step {}; "
          "take other starts, a finer reference or a shorter horizon",
          first + k, reference_->description(), measure_->name, its->step));
    }
  }

 private:
  struct failure {
    std::int64_t step;
    bool without_scale;
  };

  void inspect(std::span<const T> here) {
    auto sound = is_finite(x_);
    for (const T& number : here) sound = both(sound, number - number == T(0.0));
    std::optional<T> scale;
    if (measure_->scale) scale = measure_->scale(here);
    for (int k = 0; k < count_; ++k) {
      auto& its = failures_[static_cast<std::size_t>(k)];
      const bool without_scale = scale && lane(*scale, k) == 0.0;
      if (its || (lane(sound, k) && !without_scale)) continue;
      its = failure{at_.step, lane(sound, k)};
    }
  }

  const S* system_;
  const R* reference_;
  const measure_type* measure_;
  state x_;
  int count_;
  path_place at_;
  path_type* path_;
  std::vector<vector<T, S::dimension>> noise_;
  std::vector<T> numbers_;
  std::array<std::optional<failure>, lanes_of<S>> failures_{};
};

/// What is left of a run: its score, or NaN and the step at which it diverged.
struct run_score {
  double value = std::numeric_limits<double>::quiet_NaN();
  std::optional<std::int64_t> diverged_at = {};
};

/// The errors of one trajectory in each lane, added up in the order of time. None is kept.
template <int N, int W>
class error_sum {
 public:
  using T = scalar_of_lanes<W>;
  using numbers = std::span<const T>;

  /// Refers to the measure.
  explicit error_sum(const error_measure<N, W>& measure) : measure_(&measure) {}

  /// Sample i = 1, 2, ..., in this order, of the lanes that are live.
  void add(std::int64_t i, numbers seen, numbers reference, const condition_of<T>& live) {
    sum_ = select(live, sum_ + measure_->error(seen, reference), sum_);
    samples_ = i;
    const auto lost = both(!(sum_ - sum_ == T(0.0)), live);
    if (!any(lost)) return;
    for (int k = 0; k < W; ++k) {
      auto& at = lost_at_[static_cast<std::size_t>(k)];
      if (lane(lost, k) && !at) at = i;
    }
  }

  /// That of lane k, which diverged where its state did, or where the error was no longer finite.
  run_score score(int k, std::optional<std::int64_t> diverged_at = {}) const {
    const auto lost_at = lost_at_[static_cast<std::size_t>(k)];
    if (lost_at) return {.diverged_at = lost_at};
    if (diverged_at) return {.diverged_at = diverged_at};
    return {.value = measure_->score(lane(sum_, k), static_cast<double>(samples_))};
  }

 private:
  const error_measure<N, W>* measure_;
  T sum_{0.0};
  std::int64_t samples_ = 0;
  std::array<std::optional<std::int64_t>, W> lost_at_{};
};

}  // namespace nysalt
