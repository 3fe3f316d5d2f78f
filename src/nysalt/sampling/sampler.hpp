// SPDX-License-Identifier: BSL-1.0
// The course of Hybrid Monte Carlo: burn-in, masses, draws, and states to go on from.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>
#include <span>
#include <stdexcept>
#include <tuple>
#include <vector>

#include "block_of_chains.hpp"
#include "dual_averaging.hpp"
#include "nysalt/detail/collectively.hpp"
#include "nysalt/detail/ensemble_loop.hpp"
#include "nysalt/detail/progress_of_share.hpp"
#include "nysalt/detail/sentence.hpp"
#include "nysalt/hmc.hpp"
#include "nysalt/shard.hpp"
#include "rescaled.hpp"

namespace nysalt::detail {

/// The number of steps of trajectory n of all chains: durations are uniform.
inline std::int64_t steps_of(const hmc_options& options, std::int64_t trajectory, double length,
                             double step) {
  std::array<double, 1> normal{};
  standard_normals<double>(options.seed, {.step = trajectory, .purpose = noise_purpose::duration}, normal);
  const double uniform = 0.5 * std::erfc(-normal[0] / std::numbers::sqrt2);
  return std::max<std::int64_t>(1, std::llround(2.0 * uniform * length / step));
}

/// Chains in lanes of T.
template <class T>
class sampler {
 public:
  sampler(const model& system, const tabulated& method, const initial_states& starts,
          const hmc_options& options)
      : system_(system),
        target_(system),
        method_(method),
        options_(options),
        mine_(options.chains, *options.ranks),
        report_(progress_of_share(*options.ranks, mine_.count() * (options.burn_in + options.draws),
                                  options.chains * (options.burn_in + options.draws), options.progress)) {
    result_.step = options.step;
    const std::int64_t blocks = (mine_.count() + lanes_in<T> - 1) / lanes_in<T>;
    blocks_.resize(static_cast<std::size_t>(blocks));
    collectively(*options.ranks, [&] {
      for_each_block([&](std::size_t b, std::int64_t first, int count) {
        blocks_[b] =
            std::make_unique<block_of_chains<T>>(own_copy(system), starts, options.seed, first, count);
      });
    });
    if (options.diagonal_masses) seen_.resize(static_cast<std::size_t>(mine_.count()));
    begin_tuning();
    if (options.from != nullptr) go_on_from(*options.from);
  }

  hmc_result run(const std::function<void(const hmc_draw&)>& take) {
    while (done_ < options_.burn_in) {
      burn_in(done_);
      if (++done_ == options_.burn_in) end_burn_in();
      keep_and_report();
    }
    const std::int64_t all = options_.burn_in + options_.draws;
    while (done_ < all) {
      const std::int64_t every = options_.keep_every;
      const std::int64_t next = every > 0 ? std::min(all, (done_ / every + 1) * every) : all;
      for (std::int64_t n = done_; n < next; ++n) count_steps(n);
      collectively(*options_.ranks, [&] {
        for_each_block([&](std::size_t b, std::int64_t, int) { draw(*blocks_[b], next, take); });
      });
      done_ = next;
      keep_and_report();
    }
    const double of_draws = static_cast<double>(options_.draws);
    result_.evaluations_of_draw = evaluations(of_draws, steps_ - steps_of_burn_in_) / of_draws;
    result_.evaluations_of_burn_in = evaluations(static_cast<double>(options_.burn_in), steps_of_burn_in_);
    sum_up(of_draws);
    return result_;
  }

 private:
  void for_each_block(const std::function<void(std::size_t, std::int64_t, int)>& body) {
    nysalt::for_each_block(mine_.count(), lanes_in<T>, options_.threads, [&](std::int64_t first, int count) {
      body(static_cast<std::size_t>(first / lanes_in<T>), mine_.first() + first, count);
    });
  }

  double evaluations(double trajectories, double steps) const {
    const run_time_word& word = method_.letters();
    const auto per_step = evaluations_of(system_, word.evaluations_per_step, word.force_derivatives);
    return trajectories * (word.evaluations_to_open + word.evaluations_to_observe) +
           steps * static_cast<double>(per_step);
  }
  /// Before masses are known the length of a trajectory is some steps.
  bool is_before_masses(std::int64_t trajectory) const {
    return options_.diagonal_masses && trajectory < options_.burn_in / 2;
  }
  double length_of(std::int64_t trajectory) const {
    constexpr double some_steps = 16.0;
    return is_before_masses(trajectory) ? some_steps * result_.step : options_.length;
  }
  std::int64_t count_steps(std::int64_t trajectory) {
    const std::int64_t steps = steps_of(options_, trajectory, length_of(trajectory), result_.step);
    steps_ += static_cast<double>(steps);
    return steps;
  }

  void begin_tuning() {
    const double largest =
        is_before_masses(done_) ? std::numeric_limits<double>::infinity() : options_.length;
    if (options_.acceptance) tuned_.emplace(result_.step, *options_.acceptance, largest);
  }

  /// Trajectory n of all chains together, as they share the step that is tuned.
  void burn_in(std::int64_t n) {
    const std::int64_t half = options_.burn_in / 2;
    if (options_.diagonal_masses && n == half) {
      require_tuned();
      use_deviations(deviations_of(seen_, mine_, options_.chains, size(system_)));
      for (auto& block : blocks_) block->rescale(scales_);
      result_.step = 1.0;
      begin_tuning();
    }
    if (tuned_) result_.step = tuned_->step();
    const std::int64_t steps = count_steps(n);
    collectively(*options_.ranks, [&] {
      for_each_block([&](std::size_t b, std::int64_t, int) { go_on(*blocks_[b], n, steps); });
    });
    if (tuned_) tuned_->take(acceptance_of_last());
    if (options_.diagonal_masses && n >= half / 2 && n < half) watch();
  }

  void end_burn_in() {
    require_tuned();
    if (tuned_) result_.step = tuned_->settled();
    for (auto& block : blocks_) block->forget_sums();
    steps_of_burn_in_ = steps_;
  }

  void require_tuned() const {
    if (!tuned_ || !tuned_->failed()) return;
    throw std::runtime_error(
        sentence("hmc: the acceptance must reach {}, got less down to steps of {}; take a smaller "
                 "first step, "
                 "or other starts, and check the potential against the force",
                 *options_.acceptance, tuned_->settled()));
  }

  void keep_and_report() {
    if (report_) report_(done_ * mine_.count());
    if (options_.keep_every > 0 && options_.keep && done_ % options_.keep_every == 0) options_.keep(state());
  }

  void go_on(block_of_chains<T>& block, std::int64_t n, std::int64_t steps) {
    const model own = own_copy(target_);
    const auto stepper = make_stepper(own, method_, result_.step);
    block.propose(stepper, options_.temperature, options_.seed, n, steps);
  }

  /// Trajectories done_ .. next - 1.
  void draw(block_of_chains<T>& block, std::int64_t next, const std::function<void(const hmc_draw&)>& take) {
    const model own = own_copy(target_);
    const auto stepper = make_stepper(own, method_, result_.step);
    for (std::int64_t n = done_; n < next; ++n) {
      block.propose(stepper, options_.temperature, options_.seed, n,
                    steps_of(options_, n, options_.length, result_.step));
      for (int k = 0; k < block.count(); ++k) {
        Eigen::VectorXd q = block.position(k);
        if (scales_.size() > 0) q = q.cwiseProduct(scales_);
        take({block.first() + k, n - options_.burn_in, q, block.potential(k)});
      }
    }
  }

  double acceptance_of_last() const {
    std::vector<double> of_chains;
    for (const auto& block : blocks_) {
      for (int k = 0; k < block->count(); ++k) of_chains.push_back(block->sums(k).last);
    }
    return mine_.sum(of_chains) / static_cast<double>(options_.chains);
  }

  void watch() {
    std::size_t m = 0;
    for (const auto& block : blocks_) {
      for (int k = 0; k < block->count(); ++k) seen_[m++].take(block->position(k));
    }
  }

  /// Steps from now on are of coordinates in which omega is one.
  void use_deviations(const Eigen::VectorXd& deviations) {
    result_.deviations.assign(deviations.begin(), deviations.end());
    scales_ = deviations / std::sqrt(options_.temperature);
    target_ = model(rescaled(system_, scales_));
  }

  // A saved state: what all chains share, then a row for each chain.
  static constexpr std::size_t of_all = 3 + std::tuple_size_v<dual_averaging::memory>;
  std::size_t dimension() const { return static_cast<std::size_t>(size(system_)); }
  std::size_t width_of_head() const { return of_all + (options_.diagonal_masses ? dimension() : 0); }
  std::size_t width_of_row() const {
    const Eigen::Index watched = options_.diagonal_masses ? moments::width(size(system_)) : 0;
    return dimension() + 1 + static_cast<std::size_t>(chain_sums::width + watched);
  }
  saved_numbers row_of(std::span<double> numbers, std::int64_t chain) const {
    const std::size_t first = width_of_head() + static_cast<std::size_t>(chain) * width_of_row();
    return saved_numbers(numbers.subspan(first, width_of_row()));
  }

  hmc_state state() const {
    const std::size_t head = width_of_head();
    const std::size_t width = width_of_row();
    hmc_state result{done_, std::vector<double>(head + static_cast<std::size_t>(options_.chains) * width)};
    std::size_t m = 0;
    for (const auto& block : blocks_) {
      for (int k = 0; k < block->count(); ++k, ++m) {
        auto row = row_of(result.numbers, block->first() + k);
        block->write(k, row);
        if (options_.diagonal_masses) seen_[m].write(size(system_), row);
      }
    }
    std::vector<std::size_t> first_of_rank;
    for (int r = 0; r <= options_.ranks->size(); ++r)
      first_of_rank.push_back(head + static_cast<std::size_t>(mine_.first_of(r)) * width);
    first_of_rank.front() = 0;  // the head is of rank 0
    saved_numbers shared(std::span<double>(result.numbers).first(head));
    for (const double x : {result_.step, steps_, steps_of_burn_in_}) shared.put(x);
    for (const double x : tuned_ ? tuned_->saved() : dual_averaging::memory{}) shared.put(x);
    for (const double x : result_.deviations) shared.put(x);
    all_gather_items(*options_.ranks, result.numbers, first_of_rank);
    return result;
  }

  void go_on_from(const hmc_state& saved) {
    const std::size_t wanted = width_of_head() + static_cast<std::size_t>(options_.chains) * width_of_row();
    if (saved.numbers.size() != wanted || saved.trajectories < 0 ||
        saved.trajectories > options_.burn_in + options_.draws) {
      throw std::invalid_argument(
          sentence("hmc: the state to go on from must be of these options: {} numbers after at most {} "
                   "trajectories, got "
                   "{} after {}",
                   wanted, options_.burn_in + options_.draws, saved.numbers.size(), saved.trajectories));
    }
    done_ = saved.trajectories;
    std::vector<double> numbers = saved.numbers;
    saved_numbers shared(std::span<double>(numbers).first(width_of_head()));
    for (double* x : {&result_.step, &steps_, &steps_of_burn_in_}) *x = shared.get();
    dual_averaging::memory memory{};
    for (double& x : memory) x = shared.get();
    if (tuned_) tuned_->restore(memory);
    if (options_.diagonal_masses && done_ > options_.burn_in / 2) {
      Eigen::VectorXd deviations(size(system_));
      for (double& x : deviations) x = shared.get();
      use_deviations(deviations);
    }
    std::size_t m = 0;
    for (auto& block : blocks_) {
      for (int k = 0; k < block->count(); ++k, ++m) {
        auto row = row_of(numbers, block->first() + k);
        block->read(k, row);
        if (options_.diagonal_masses) seen_[m].read(size(system_), row);
      }
    }
  }

  void sum_up(double draws) {
    std::vector<double> acceptances(static_cast<std::size_t>(options_.chains));
    std::vector<double> squares = acceptances;
    std::vector<double> diverged;
    for (const auto& block : blocks_) {
      for (int k = 0; k < block->count(); ++k) {
        const auto m = static_cast<std::size_t>(block->first() + k);
        const chain_sums& sums = block->sums(k);
        acceptances[m] = sums.acceptance / draws;
        squares[m] = sums.squares / draws;
        diverged.push_back(sums.diverged);
      }
    }
    mine_.gather(acceptances);
    mine_.gather(squares);
    result_.acceptance = mean_and_error(acceptances);
    result_.square_of_energy_error = mean_and_error(squares);
    result_.diverged = static_cast<std::int64_t>(mine_.sum(diverged));
  }

  const model& system_;
  model target_;  // what is stepped: the system, or in units of its deviations
  const tabulated& method_;
  const hmc_options& options_;
  shard mine_;
  std::function<void(std::int64_t)> report_;
  std::vector<std::unique_ptr<block_of_chains<T>>> blocks_;
  std::optional<dual_averaging> tuned_;
  std::vector<moments> seen_;  // of the chains of this rank, with `diagonal_masses`
  hmc_result result_;
  Eigen::VectorXd scales_;         // with `diagonal_masses`, positions are these times those that are stepped
  std::int64_t done_ = 0;          // trajectories of each chain
  double steps_ = 0.0;             // of one chain so far
  double steps_of_burn_in_ = 0.0;  // of one chain
};

}  // namespace nysalt::detail
