// SPDX-License-Identifier: BSL-1.0
// Many trajectories that can be saved between two steps, and resumed later.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "nysalt/detail/ensemble_loop.hpp"
#include "nysalt/detail/lockstep.hpp"
#include "nysalt/detail/sentence.hpp"
#include "nysalt/ensemble.hpp"

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
  using runs = lockstep<Stepper, T>;
  using state = phase_point<T, N>;

 public:
  /// A run at the initial states. Throws std::invalid_argument if there are none, or one does not fit.
  template <Ensemble<typename Stepper::system_type> E>
  ensemble_run(const Stepper& stepper, const E& ensemble, std::uint64_t seed, std::int64_t first,
               std::int64_t count, int threads = 1)
      : stepper_(&stepper), first_(first), count_(count) {
    begin(ensemble, seed, threads, [&](std::int64_t block, int size, const state& start) {
      return runs(stepper_of(block), start, size, first_ + block);
    });
  }

  /// A run that resumes from `saved`. Throws std::invalid_argument if it is of another number of trajectories
  /// or coordinates.
  template <Ensemble<typename Stepper::system_type> E>
  ensemble_run(const Stepper& stepper, const E& ensemble, std::uint64_t seed, std::int64_t first,
               std::int64_t count, const saved_runs& saved, int threads = 1)
      : stepper_(&stepper), first_(first), count_(count) {
    require_fitting(saved);
    begin(ensemble, seed, threads, [&](std::int64_t block, int size, const state& start) {
      return take_up(saved, block, size, start);
    });
  }

  /// Goes on to step `end`. At steps n that `every` divides, beyond step() and at 0 before the first step,
  /// read(x, numbers) and take(m, n, numbers) are called as by integrate_ensemble(). Divergence is checked
  /// at `end` too: cut a run at multiples of steps_between_checks, and it is as if uncut.
  template <class Read, class Take>
  void go_on(std::int64_t end, std::int64_t every, std::size_t width_of_numbers, const Read& read,
             const Take& take, int threads = 1, const std::function<void(std::int64_t)>& progress = {}) {
    if (end <= step_) return;
    const auto follow = [&](std::int64_t b, int) {
      const std::int64_t first = b * width;
      const auto size = static_cast<int>(std::min<std::int64_t>(width, count_ - first));
      detail::take_in_order<Take> hand_over(take, first_ + first, size, width_of_numbers);
      const auto at = static_cast<std::size_t>(b);
      if (!starts_.empty()) detail::observe_starts(starts_[at], size, width_of_numbers, read, hand_over);
      blocks_[at]->go_on(end, every, width_of_numbers, read, hand_over);
    };
    const auto all = static_cast<std::int64_t>(blocks_.size());
    const auto in_trajectories = [&](std::int64_t done) { progress(std::min(done * width, count_)); };
    for_each_block(all, 1, threads, follow,
                   progress ? std::function<void(std::int64_t)>(in_trajectories) : nullptr);
    step_ = end;
    starts_.clear();
  }

  /// The state from which a later ensemble_run of the same trajectories resumes. Between two calls of
  /// go_on().
  saved_runs save() const {
    const auto each = static_cast<std::size_t>(3 * size(stepper_->system()));
    saved_runs result{step_, {}, {}};
    result.numbers.reserve(each * static_cast<std::size_t>(count_));
    for (std::int64_t m = 0; m < count_; ++m) {
      const runs& block = *blocks_[static_cast<std::size_t>(m / width)];
      const auto k = static_cast<int>(m % width);
      result.diverged_at.push_back(block.diverged_at(k));
      const auto& x = block.open().state;
      const bool is_lost = block.diverged_at(k).has_value();
      for (const auto* part : {&x.q, &x.p, &x.f}) {
        for (Eigen::Index i = 0; i < part->size(); ++i) {
          result.numbers.push_back(is_lost ? 0.0 : lane((*part)[i], k));
        }
      }
    }
    return result;
  }

  std::int64_t step() const { return step_; }  ///< steps that every trajectory has done
  /// |H - H_0| of trajectory m where it is, unless it diverged.
  double energy_error(std::int64_t m) const {
    const std::int64_t at = m - first_;
    return blocks_[static_cast<std::size_t>(at / width)]->energy_error(static_cast<int>(at % width));
  }
  /// Step of divergence of trajectory m, if any.
  std::optional<std::int64_t> diverged_at(std::int64_t m) const {
    const std::int64_t at = m - first_;
    return blocks_[static_cast<std::size_t>(at / width)]->diverged_at(static_cast<int>(at % width));
  }

 private:
  using make_runs = std::function<runs(std::int64_t block, int size, const state& start)>;

  void begin(const auto& ensemble, std::uint64_t seed, int threads, const make_runs& make) {
    if (count_ < 1 || first_ < 0) {
      throw std::invalid_argument(
          sentence("ensemble_run: trajectories must be >= 1 and first >= 0, got trajectories {} and first {}",
                   count_, first_));
    }
    const std::int64_t blocks = (count_ - 1) / width + 1;
    blocks_.resize(static_cast<std::size_t>(blocks));
    if (step_ == 0) starts_.resize(blocks_.size());
    if constexpr (ErasedSystem<typename Stepper::system_type>) {
      if (is_black_box(stepper_->system())) own_.resize(blocks_.size());
    }
    for_each_block(blocks, 1, threads, [&](std::int64_t b, int) {
      const std::int64_t block = b * width;
      const auto size = static_cast<int>(std::min<std::int64_t>(width, count_ - block));
      const auto start = sound_starts<T>(stepper_->system(), ensemble, seed, first_ + block, size);
      blocks_[static_cast<std::size_t>(b)].emplace(make(block, size, start));
      if (!starts_.empty()) starts_[static_cast<std::size_t>(b)] = start;
    });
  }

  void require_fitting(const saved_runs& saved) {
    const auto each = static_cast<std::size_t>(3 * size(stepper_->system()));
    const auto count = static_cast<std::size_t>(std::max<std::int64_t>(count_, 0));
    if (saved.diverged_at.size() != count || saved.numbers.size() != each * count || saved.step < 0) {
      throw std::invalid_argument(
          sentence("ensemble_run: saved runs must hold {} numbers of {} trajectories at a step >= 0, got {} "
                   "numbers of {} at step {}",
                   each * count, count, saved.numbers.size(), saved.diverged_at.size(), saved.step));
    }
    step_ = saved.step;
  }

  runs take_up(const saved_runs& saved, std::int64_t block, int count, const state& start) {
    const auto n = size(stepper_->system());
    open_run<T, N> run{{start, start.q}, saved.step, static_cast<std::uint64_t>(first_ + block)};
    first_in_lanes<T> lost;
    for (int k = 0; k < count; ++k) {
      const auto m = static_cast<std::size_t>(block + k);
      lost.set(k, saved.diverged_at[m]);
      const double* next_number = saved.numbers.data() + m * static_cast<std::size_t>(3 * n);
      for (auto* part : {&run.state.q, &run.state.p, &run.state.f}) {
        for (Eigen::Index i = 0; i < n; ++i) set_lane((*part)[i], k, *next_number++);
      }
    }
    return runs(stepper_of(block), start, count, std::move(run), lost);
  }

  /// For a black box, whose force may have memory, a copy of the system that only one block uses.
  struct own_system {
    explicit own_system(const Stepper& of)
        : system(of.system().separate()), stepper(of.with_system(system)) {}

    typename Stepper::system_type system;
    Stepper stepper;
  };

  const Stepper& stepper_of(std::int64_t block) {
    if constexpr (ErasedSystem<typename Stepper::system_type>) {
      if (!own_.empty()) {
        auto& own = own_[static_cast<std::size_t>(block / width)];
        if (!own) own = std::make_unique<own_system>(*stepper_);
        return own->stepper;
      }
    }
    return *stepper_;
  }

  const Stepper* stepper_;
  std::int64_t first_;
  std::int64_t count_;
  std::int64_t step_ = 0;
  std::vector<std::unique_ptr<own_system>>
      own_;  // before the runs that refer to it; empty but for black boxes
  std::vector<std::optional<runs>> blocks_;
  std::vector<state> starts_;  // until they were observed
};

}  // namespace nysalt
