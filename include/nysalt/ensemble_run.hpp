// SPDX-License-Identifier: BSL-1.0
// Many trajectories that can be saved between two steps, and resumed later.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "nysalt/core/sentence.hpp"
#include "nysalt/ensemble.hpp"
#include "nysalt/execution.hpp"
#include "nysalt/parallel/ensemble_loop.hpp"
#include "nysalt/stepping/lockstep.hpp"

namespace nysalt {

/// The state from which trajectories of a known ensemble are resumed, all at one step: their open runs,
/// independent of the lanes and threads that they were stepped in.
struct saved_runs {
  std::int64_t step = 0;        ///< steps that every trajectory has done
  std::vector<double> numbers;  ///< q, p and f of one trajectory after the other; 0 of those that diverged
  std::vector<std::optional<std::int64_t>> diverged_at;  ///< step of divergence of each trajectory, if any
};

/// Trajectories m = first .. first + count - 1 from ensemble(seed, m), with the noise of their numbers. As
/// many as T has lanes are stepped together, on several threads; neither changes a bit.
///
///   ensemble_run<T, Stepper> run(stepper, ensemble, 1, 0, 1000);
///   run.go_on(64 * 1000, ...);
///   const saved_runs here = run.save();      // a file can hold it
///   ensemble_run<T, Stepper> later(stepper, ensemble, 1, 0, 1000, here);
///
/// Memory: twice the states. Refers to the stepper.
template <class T, class Stepper>
class ensemble_run {
  static constexpr int N = Stepper::dimension;
  static constexpr int width = lanes_in<T>;
  using runs = detail::lockstep<Stepper, T>;
  using state = phase_point<T, N>;

  struct block {
    detail::own_stepper<Stepper> stepper;
    runs run;
    std::int64_t first;  // place of the trajectory in lane 0
    int count;
    std::optional<state> start;  // until it was observed
  };

 public:
  /// A run at the initial states, made on the threads of `how`. Throws std::invalid_argument if there are
  /// none, or one does not fit.
  template <Ensemble<typename Stepper::system_type> E>
  ensemble_run(const Stepper& stepper, const E& ensemble, std::uint64_t seed, std::int64_t first,
               std::int64_t count, const execution& how = {})
      : ensemble_run(stepper, ensemble, seed, first, count, nullptr, how) {}

  /// A run that resumes from `saved`. Throws std::invalid_argument if it is of another number of trajectories
  /// or coordinates.
  template <Ensemble<typename Stepper::system_type> E>
  ensemble_run(const Stepper& stepper, const E& ensemble, std::uint64_t seed, std::int64_t first,
               std::int64_t count, const saved_runs& saved, const execution& how = {})
      : ensemble_run(stepper, ensemble, seed, first, count, &saved, how) {}

  /// Goes on to step `end`. At steps n that `every` divides, beyond step() and at 0 before the first step,
  /// read(x, numbers) and take(m, n, numbers) are called as by integrate_ensemble(). Divergence is checked
  /// at `end` too: cut a run at multiples of steps_between_checks, and it is as if uncut. Threads and
  /// progress are those of `how`; its ranks are ignored, as all trajectories of the run are of this one.
  template <class Read, class Take>
  void go_on(std::int64_t end, std::int64_t every, std::size_t width_of_numbers, const Read& read,
             const Take& take, const execution& how = {}) {
    if (end <= step_) return;
    const auto follow = [&](std::int64_t b) {
      block& here = *blocks_[static_cast<std::size_t>(b)];
      detail::take_in_order<Read, Take> taken{read, take, first_ + here.first, here.count,
                                              std::vector<double>(width_of_numbers)};
      if (here.start) detail::see_starts<T>(*here.start, here.count, taken);
      here.start.reset();
      here.run.go_on(end, every, taken);
    };
    const auto in_trajectories = [&](std::int64_t done) { how.progress(std::min(done * width, count_)); };
    for_each_trajectory(
        std::ssize(blocks_),
        {.threads = how.threads, .progress = how.progress ? progress_callback(in_trajectories) : nullptr},
        follow);
    step_ = end;
  }

  /// The state from which a later ensemble_run of the same trajectories resumes. Between two calls of
  /// go_on().
  saved_runs save() const {
    saved_runs result{step_, {}, {}};
    result.numbers.reserve(static_cast<std::size_t>(3 * size(stepper_->system()) * count_));
    for (const auto& here : blocks_) {
      for (int k = 0; k < here->count; ++k) {
        const bool is_lost = result.diverged_at.emplace_back(here->run.diverged_at(k)).has_value();
        const auto& x = here->run.open().state;
        for (const auto* part : {&x.q, &x.p, &x.f}) {
          for (const T& number : *part) result.numbers.push_back(is_lost ? 0.0 : lane(number, k));
        }
      }
    }
    return result;
  }

  std::int64_t step() const { return step_; }  ///< steps that every trajectory has done
  /// |H - H_0| of trajectory m where it is, unless it diverged.
  double energy_error(std::int64_t m) const { return run_of(m).energy_error(lane_of(m)); }
  /// Step of divergence of trajectory m, if any.
  std::optional<std::int64_t> diverged_at(std::int64_t m) const { return run_of(m).diverged_at(lane_of(m)); }

 private:
  ensemble_run(const Stepper& stepper, const auto& ensemble, std::uint64_t seed, std::int64_t first,
               std::int64_t count, const saved_runs* saved, const execution& how)
      : stepper_(&stepper), first_(first), count_(count) {
    detail::require_trajectories("ensemble_run", count, first);
    if (saved != nullptr) require_fitting(*saved);
    blocks_.resize(static_cast<std::size_t>((count - 1) / width + 1));
    const auto make = [&](detail::own_stepper<Stepper> own, std::int64_t place, int here) {
      const auto start = detail::sound_starts<T>(stepper.system(), ensemble, seed, first + place, here);
      runs run = saved == nullptr ? runs(*own, start, here, first + place)
                                  : resumed(*own, start, here, *saved, place);
      auto& made = blocks_[static_cast<std::size_t>(place / width)];
      made = std::make_unique<block>(block{std::move(own), std::move(run), place, here, {}});
      if (step_ == 0) made->start = start;
    };
    detail::for_each_lane_block(stepper, shard(count), width, {.threads = how.threads}, make);
  }

  void require_fitting(const saved_runs& saved) {
    const auto each = static_cast<std::size_t>(3 * size(stepper_->system()));
    const auto count = static_cast<std::size_t>(count_);
    if (saved.diverged_at.size() != count || saved.numbers.size() != each * count || saved.step < 0) {
      throw std::invalid_argument(
          sentence("ensemble_run: saved runs must hold {} numbers of {} trajectories at a step >= 0, got {} "
                   "numbers of {} at step {}",
                   each * count, count, saved.numbers.size(), saved.diverged_at.size(), saved.step));
    }
    step_ = saved.step;
  }

  runs resumed(const Stepper& stepper, const state& start, int count, const saved_runs& saved,
               std::int64_t place) const {
    open_run<T, N> run{{start, start.q}, saved.step, static_cast<std::uint64_t>(first_ + place)};
    detail::first_in_lanes<T> lost;
    const double* next_number = saved.numbers.data() + 3 * start.size() * place;
    for (int k = 0; k < count; ++k) {
      lost.set(k, saved.diverged_at[static_cast<std::size_t>(place + k)]);
      for (auto* part : {&run.state.q, &run.state.p, &run.state.f}) {
        for (T& number : *part) detail::set_lane(number, k, *next_number++);
      }
    }
    return runs(stepper, start, count, std::move(run), lost);
  }

  const runs& run_of(std::int64_t m) const {
    return blocks_[static_cast<std::size_t>((m - first_) / width)]->run;
  }
  int lane_of(std::int64_t m) const { return static_cast<int>((m - first_) % width); }

  const Stepper* stepper_;
  std::int64_t first_;
  std::int64_t count_;
  std::int64_t step_ = 0;
  std::vector<std::unique_ptr<block>> blocks_;
};

}  // namespace nysalt
