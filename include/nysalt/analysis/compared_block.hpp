// SPDX-License-Identifier: BSL-1.0
// Methods beside the reference, along trajectories side by side.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <stdexcept>
#include <type_traits>
#include <vector>

#include "nysalt/analysis/error_along.hpp"
#include "nysalt/langevin.hpp"
#include "nysalt/lockstep.hpp"
#include "nysalt/method.hpp"
#include "nysalt/noises/along_path.hpp"

namespace nysalt {

/// How far methods may share noise with a reference: in how many parts of a step it is told, and whose.
struct shared_noise {
  int parts = 0;  // 0: there is none
  std::uint64_t seed = 0;
  std::int64_t first = 0;  // trajectory in lane 0
};

/// Methods of one type beside the reference, from the same starts and with its noise; one trajectory in each
/// lane.
template <Method M, SeparableSystem S, Reference<S> R>
class compared_block {
 public:
  using measure_type = error_measure<S::dimension, lanes_of<S>>;
  using T = typename measure_type::T;
  using state = phase_point<T, S::dimension>;
  using errors_type = error_sum<S::dimension, lanes_of<S>>;
  using path_type = recorded_path<T, S::dimension>;
  using noise_type = std::conditional_t<PathReference<R, S>, along_path<T, S::dimension>, no_noise>;

  /// Refers to all but the start, and partly to itself.
  compared_block(const S& system, const R& reference, std::span<const M> methods, double step,
                 const measure_type& measure, const state& start, int count, int to_check,
                 const shared_noise& noise)
      : measure_(&measure),
        step_(step),
        at_start_(measure.numbers_of(start)),
        live_(first_lanes<T>(count)),
        path_(path_in(system, step, noise)) {
    const path_place at{noise.seed, static_cast<std::uint64_t>(noise.first), 0};
    if (measure.needs_reference || noise.parts > 0) {
      reference_.emplace(system, reference, measure, start, count, at, &path_, noise.parts);
    }
    if (measure.needs_reference && to_check > 0) {
      its_finer_self_.emplace(reference.finer());
      finer_.emplace(system, *its_finer_self_, measure, start, to_check, at);
      check_.emplace(measure);
    }
    for (const M& method : methods)
      steppers_.push_back(make_stepper(system, method, step, noise_of(method, noise)));
    for (const auto& stepper : steppers_) {
      runs_.push_back({{stepper, start, count, noise.first}, errors_type(measure)});
    }
    if (!measure.needs_reference && measure.scale) require_scale(count);
  }

  compared_block(const compared_block&) = delete;
  compared_block& operator=(const compared_block&) = delete;

  /// All of them, a stretch after the other, so that no path is kept.
  void run(std::int64_t steps) {
    for (std::int64_t done = 0; done < steps; done += steps_between_checks) {
      const std::int64_t next = std::min(done + steps_between_checks, steps);
      if (reference_) reference_->go_on(step_, next - done);
      if (finer_) finer_->go_on(step_, next - done);
      const auto expected = [&](std::int64_t n) {
        return measure_->needs_reference ? reference_->at(n - done - 1) : std::span<const T>(at_start_);
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
  using stepper_type = stepper<S, typename M::word, double, noise_type>;
  struct watched_run {
    lockstep<stepper_type, T> run;
    errors_type errors;
  };

  /// Held in parts of a step.
  static path_type path_in(const S& system, double step, const shared_noise& noise) {
    double friction = 0.0;
    if constexpr (HasBath<S>) friction = static_cast<const bath&>(system.bath()).friction();
    return {std::abs(step) / std::max(noise.parts, 1), friction, static_cast<std::uint64_t>(noise.first)};
  }
  noise_type noise_of(const M& method, const shared_noise& noise) const {
    if constexpr (PathReference<R, S>) {
      if (noise.parts == 0) return {path_, {}, step_};
      return {path_, intervals_of_noise(word_of(method), method.coefficients()), step_};
    } else {
      return {};
    }
  }

  void require_scale(int count) const {
    const T scale = measure_->scale(at_start_);
    for (int k = 0; k < count; ++k) {
      if (lane(scale, k) == 0.0) throw std::invalid_argument(measure_->no_scale);
    }
  }

  const measure_type* measure_;
  double step_;
  std::vector<T> at_start_;
  condition_of<T> live_;
  path_type path_;  // of the stretch at hand
  std::optional<reference_along<S, R>> reference_;
  std::optional<R> its_finer_self_;
  std::optional<reference_along<S, R>> finer_;
  std::optional<errors_type> check_;  // of the reference against its finer self
  std::vector<stepper_type> steppers_;
  std::vector<watched_run> runs_;
};

}  // namespace nysalt
