// SPDX-License-Identifier: BSL-1.0
// Trajectories side by side, each watched over.
#pragma once

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "nysalt/core/sentence.hpp"
#include "nysalt/divergence.hpp"
#include "nysalt/stepper.hpp"

namespace nysalt {

namespace detail {

/// What is measured of trajectories side by side in the lanes of T:
/// width()                how many numbers are read of a state
/// read(x, numbers)       writes them to a span; of lanes that are lost too
/// see(n, numbers, live)  takes the numbers of step n, in the order of time; live: lanes that are good at n
/// What it found is its own: as a result at the end, or in the places of the trajectories.
template <class M, class T, int N>
concept Measure = requires(M& measure, const phase_point<T, N>& x, std::span<T> numbers, std::int64_t n,
                           std::span<const T> read, const detail::condition_of<T>& live) {
  { measure.width() } -> std::convertible_to<std::size_t>;
  measure.read(x, numbers);
  measure.see(n, read, live);
};

/// The trajectories in the lanes of T, all at the same step. Each has the bits of a run of its own: one
/// that diverges drops out, and the others go on.
///
/// Divergence is checked every 64 steps and where go_on ends; where it is found, these steps are taken
/// again to name the first bad step.
template <class Stepper, Scalar T>
class lockstep {
 public:
  static constexpr int dimension = Stepper::dimension;  ///< degrees of freedom
  static constexpr int lanes = lanes_in<T>;             ///< how many trajectories at most
  using state = phase_point<T, dimension>;              ///< of all lanes
  using condition = condition_of<T>;                    ///< a bool for one lane, else a mask

  /// Trajectories that begin at `start`. Refers to the stepper. Lanes from `count` on hold no trajectory;
  /// lane 0 holds number `first`, whose noise it sees. Throws std::invalid_argument if the start does not
  /// fit; that it is finite is up to the caller.
  lockstep(const Stepper& stepper, const state& start, int count, std::int64_t first = 0)
      : lockstep(stepper, start, count, stepper.open(start, static_cast<std::uint64_t>(first)), {}) {}

  /// Resumes what was saved: open() and diverged_at() of trajectories that began at `start`. If it was
  /// saved at a step that steps_between_checks divides, the run has the bits of an uninterrupted one.
  lockstep(const Stepper& stepper, const state& start, int count, open_run<T, dimension> run,
           const first_in_lanes<T>& diverged_at)
      : stepper_(&stepper),
        run_(std::move(run)),
        good_(run_),
        diverged_(stepper.system(), start),
        live_(first_lanes<T>(count)),
        diverged_at_(diverged_at) {
    for (int k = 0; k < count; ++k) {
      if (this->diverged_at(k)) set_lane(live_, k, false);
    }
  }

  /// Goes on to step `end`, unless no lane is live any more. The measure sees each step that `every` divides;
  /// it reads a few steps ahead perhaps.
  void go_on(std::int64_t end, std::int64_t every, Measure<T, dimension> auto& measure) {
    if (every < 1) throw std::invalid_argument(sentence("lockstep: every must be >= 1, got {}", every));
    const std::size_t width = measure.width();
    seen_.resize(width * static_cast<std::size_t>(steps_between_checks / every + 1));
    const auto advance = [&](std::int64_t next) {
      T* here = seen_.data();
      stepper_->advance(run_, next - run_.step, every, [&](std::int64_t, const state& x) {
        measure.read(x, std::span<T>(here, width));
        here += width;
      });
    };
    follow(end, advance, [&](std::int64_t next, bool all_well) {
      const T* here = seen_.data();
      for (std::int64_t n = (good_.step / every + 1) * every; n <= next; n += every, here += width) {
        measure.see(n, std::span<const T>(here, width), all_well ? live_ : good_at(n));
      }
    });
  }
  /// Goes on to step `end`, unobserved.
  void go_on(std::int64_t end) {
    follow(
        end, [&](std::int64_t next) { stepper_->advance(run_, next - run_.step); }, [](auto&&...) {});
  }

  std::int64_t step() const { return run_.step; }              ///< at which all are
  const open_run<T, dimension>& open() const { return run_; }  ///< all that is needed to go on
  /// The run at the last check.
  const open_run<T, dimension>& begin_of_window() const { return good_; }
  /// The states at that step. Of lanes that diverged nothing is known but when; of a single one it is the
  /// first bad state.
  state synchronous() const { return stepper_->synchronous(run_); }
  const condition& live() const { return live_; }  ///< those that go on
  /// |H - H_0| of lane k where it is; of lanes that diverged nothing is known.
  double energy_error(int k) const { return lane(energy_error_, k); }
  /// The step at which lane k diverged; nothing while it goes on.
  std::optional<std::int64_t> diverged_at(int k) const { return diverged_at_[k]; }

 private:
  /// From check to check: advance(next) takes the run to step `next`, seen(next, all_well) comes when
  /// those that diverged are known.
  void follow(std::int64_t end, const auto& advance, const auto& seen) {
    while (run_.step < end && any(live_)) {
      good_ = run_;
      const std::int64_t next = std::min((run_.step / steps_between_checks + 1) * steps_between_checks, end);
      advance(next);
      stepper_->of_kernel(run_, checked_);
      const condition failed = both(diverged_(checked_), live_);
      energy_error_ = diverged_.last_change();
      const bool all_well = !any(failed);
      if (!all_well) drop(failed, next);
      seen(next, all_well);
    }
  }

  /// The steps since the last check once more, one at a time, until the first bad step of each lane that
  /// failed is known.
  void drop(const condition& failed, std::int64_t end) {
    live_ = both(live_, !failed);
    open_run<T, dimension> run = good_;
    condition unknown = failed;
    while (any(unknown)) {
      stepper_->advance(run, 1);
      condition found = unknown;  // at the present check at the latest
      if (run.step < end) {
        stepper_->of_kernel(run, checked_);
        found = both(unknown, diverged_(checked_));
      }
      diverged_at_.take(found, run.step);
      unknown = both(unknown, !found);
    }
    if (!any(live_)) run_ = std::move(run);  // of one trajectory the first bad step
  }

  condition good_at(std::int64_t n) const {
    condition result = live_;
    for (int k = 0; k < lanes; ++k) {
      const auto at = diverged_at(k);
      if (at && n < *at) set_lane(result, k, true);
    }
    return result;
  }

  const Stepper* stepper_;
  open_run<T, dimension> run_;
  open_run<T, dimension> good_;
  flow_state<T, dimension> checked_;  // the state at a check: kept, so that no check allocates
  divergence<typename Stepper::system_type, T> diverged_;
  T energy_error_{};
  condition live_;
  first_in_lanes<T> diverged_at_{};
  std::vector<T> seen_;
};

/// Step 0 of trajectories side by side.
template <class T, int N>
void see_starts(const phase_point<T, N>& starts, int count, Measure<T, N> auto& measure) {
  std::vector<T> numbers(measure.width());
  measure.read(starts, std::span<T>(numbers));
  measure.see(0, std::span<const T>(numbers), first_lanes<T>(count));
}

/// What read(x, numbers) writes of trajectories first, first + 1, ... side by side, handed to take(m, n,
/// numbers) of one after the other, in doubles: only of those that are good.
template <class Read, class Take>
struct take_in_order {
  const Read& read_of;
  const Take& take;
  std::int64_t first;
  int count;
  std::vector<double> of_one;

  std::size_t width() const { return of_one.size(); }
  void read(const auto& x, auto numbers) const { read_of(x, numbers); }
  template <class T>
  void see(std::int64_t n, std::span<const T> all, const condition_of<T>& live) {
    for (int k = 0; k < count; ++k) {
      if (!lane(live, k)) continue;
      for (std::size_t i = 0; i < of_one.size(); ++i) of_one[i] = lane(all[i], k);
      take(first + k, n, std::span<const double>(of_one));
    }
  }
};

}  // namespace detail

}  // namespace nysalt
