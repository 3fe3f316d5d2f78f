// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <Eigen/Core>
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
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "nysalt/communicator.hpp"
#include "nysalt/core/sentence.hpp"
#include "nysalt/hmc.hpp"
#include "nysalt/initial_states.hpp"
#include "nysalt/integrate_ensemble.hpp"
#include "nysalt/method.hpp"
#include "nysalt/model.hpp"
#include "nysalt/noises/counter_noise.hpp"
#include "nysalt/parallel/ensemble_loop.hpp"
#include "nysalt/shard.hpp"
#include "nysalt/stepper.hpp"

namespace nysalt::detail {

/// Throws std::invalid_argument, in the name of `who`, if the method is not reversible, the system is in a
/// bath that acts, or kT is not positive and finite.
void require_metropolis_applies(const char* who, const model& system, const nysalt::method& method,
                                double temperature);

/// Rises H' - H of the energy along trajectories of an ensemble.
struct energy_rises {
  std::vector<double> of_each;  ///< after each of the samples but the start, one trajectory after the other
  std::vector<std::optional<std::int64_t>> diverged_at;  ///< steps of divergence, on all ranks
};

/// The rises on the trajectories of this rank; infinite once a trajectory has diverged. Collective.
energy_rises rises_of_energy(const model& system, const nysalt::method& method, double step,
                             const initial_states& starts, const ensemble_options& options);

// Means and variances of chains, from which masses follow.

/// Numbers of a state that is saved or restored, one after the other.
class saved_numbers {
 public:
  saved_numbers(std::span<double> numbers, bool restores) : left_(numbers), restores_(restores) {}
  /// Saves x as the next number, or restores it.
  void pass(double& x) {
    (restores_ ? x : left_.front()) = restores_ ? left_.front() : x;
    left_ = left_.subspan(1);
  }

 private:
  std::span<double> left_;
  bool restores_;
};

/// Mean and variance of the draws of a chain, by Welford's recurrence.
struct moments {
  double count = 0.0;
  Eigen::VectorXd mean;
  Eigen::VectorXd squares;

  void take(const Eigen::VectorXd& x) {
    if (count == 0.0) mean = squares = Eigen::VectorXd::Zero(x.size());
    count += 1.0;
    const Eigen::VectorXd before = x - mean;
    mean += before / count;
    squares += before.cwiseProduct(x - mean);
  }

  static Eigen::Index width(Eigen::Index size) { return 1 + 2 * size; }  // numbers that are saved
  void pass(Eigen::Index size, saved_numbers& row) {
    row.pass(count);
    if (mean.size() == 0) mean = squares = Eigen::VectorXd::Zero(size);
    for (double& x : mean) row.pass(x);
    for (double& x : squares) row.pass(x);
  }
};

/// The standard deviation of each coordinate over all chains, about the mean of all. Throws
/// std::runtime_error if a coordinate did not vary.
Eigen::VectorXd deviations_of(const std::vector<moments>& of_chains, const shard& mine, std::int64_t chains,
                              Eigen::Index size);

/// A system in the coordinates q_i/s_i and of unit masses: V(s q').
class rescaled {
 public:
  static constexpr int dimension = Eigen::Dynamic;

  rescaled(model system, Eigen::VectorXd scales) : system_(std::move(system)), scales_(std::move(scales)) {}

  Eigen::Index size() const { return scales_.size(); }
  std::string description() const { return system_.description(); }

  template <class T>
    requires requires(const model& of, const vector<T, dimension>& q, vector<T, dimension>& f) {
      of.force(q, f);
    }
  void force(const vector<T, dimension>& q, vector<T, dimension>& f) const {
    vector<T, dimension> whole(q.size());
    for (Eigen::Index i = 0; i < q.size(); ++i) whole[i] = q[i] * scales_[i];
    system_.force(whole, f);
    for (Eigen::Index i = 0; i < q.size(); ++i) f[i] = f[i] * scales_[i];
  }
  template <Served T>
  T potential(const vector<T, dimension>& q) const {
    vector<T, dimension> whole(q.size());
    for (Eigen::Index i = 0; i < q.size(); ++i) whole[i] = q[i] * scales_[i];
    return system_.potential(whole);
  }

 private:
  model system_;
  Eigen::VectorXd scales_;
};

/// A step whose acceptance tends to a target: Nesterov's dual averaging of log h with the constants of
/// [hoffman_gelman_2014, section 3.2.1]. Early steps can be wrong by many powers of ten, so steps are kept
/// between a thousandth of the first guess and a largest step.
class dual_averaging {
 public:
  dual_averaging(double step, double target, double largest)
      : target_(target),
        centre_(std::log(10.0 * step)),
        log_(std::log(std::min(step, largest))),
        low_(log_ - std::log(1000.0)),
        high_(std::log(largest)) {}

  /// After a trajectory that is accepted with this probability.
  void take(double acceptance) {
    constexpr double gamma = 0.05;
    constexpr double t0 = 10.0;
    constexpr double kappa = 0.75;
    count_ += 1.0;
    const double weight = 1.0 / (count_ + t0);
    error_ += weight * (target_ - acceptance - error_);
    log_ = std::clamp(centre_ - error_ * std::sqrt(count_) / gamma, low_, high_);
    const double forgetting = std::pow(count_, -kappa);
    mean_ += forgetting * (log_ - mean_);
  }

  double step() const { return std::exp(log_); }      // to try next
  double settled() const { return std::exp(mean_); }  // to go on with
  /// Whether the acceptance stayed below the target down to the smallest step.
  bool failed() const { return mean_ <= low_ + 1.0; }

  /// All that it remembers, and how it is set to that.
  using memory = std::array<double, 7>;
  memory saved() const { return {centre_, log_, mean_, error_, count_, low_, high_}; }
  void restore(const memory& saved) {
    centre_ = saved[0];
    log_ = saved[1];
    mean_ = saved[2];
    error_ = saved[3];
    count_ = saved[4];
    low_ = saved[5];
    high_ = saved[6];
  }

 private:
  double target_;
  double centre_;
  double log_;
  double low_;
  double high_;
  double mean_ = 0.0;
  double error_ = 0.0;
  double count_ = 0.0;
};

// Chains of Hybrid Monte Carlo side by side in lanes, and what each of them adds up.

/// Sums of one chain.
struct chain_sums {
  double acceptance = 0.0;
  double squares = 0.0;  // of (H' - H)/kT
  double diverged = 0.0;
  double last = 0.0;  // acceptance of the last trajectory

  static constexpr Eigen::Index width = 4;  // numbers that are saved
  void pass(saved_numbers& row) {
    for (double* x : {&acceptance, &squares, &diverged, &last}) row.pass(*x);
  }
};

/// Chains side by side in the lanes of T. `target` is what is stepped, which may be in other coordinates than
/// the positions that are drawn.
template <class T>
class block_of_chains {
 public:
  block_of_chains(const model& system, const initial_states& starts, std::uint64_t seed, std::int64_t first,
                  int count)
      : first_(first), count_(count), sums_(static_cast<std::size_t>(count)) {
    x_ =
        gather<T, Eigen::Dynamic>(count, [&](int k) { return sound_start(system, starts, seed, first + k); });
    evaluate(system);
    vector<T, Eigen::Dynamic> f(x_.q.size());
    system.force(x_.q, f);
    for (int k = 0; k < count; ++k) {
      if (std::isfinite(lane(potential_, k)) && lane(f, k).allFinite()) continue;
      throw std::invalid_argument(sentence(
          "hmc: the potential and the force must be finite at a start, got the potential {} at start {}; "
          "take other starts",
          lane(potential_, k), first + k));
    }
  }

  /// From now on positions are q/s.
  void rescale(const Eigen::VectorXd& scales) {
    for (Eigen::Index i = 0; i < scales.size(); ++i) x_.q[i] = x_.q[i] * (1.0 / scales[i]);
  }

  /// One proposal: trajectory number n, of `steps` steps, and the Metropolis test.
  void propose(const stepper<model>& stepper, double temperature, std::uint64_t seed, std::int64_t n,
               std::int64_t steps) {
    const model& system = stepper.system();
    const auto size = static_cast<std::size_t>(x_.q.size());
    normals_.resize(size + 2);
    standard_normals<T>(
        seed,
        {.trajectory = static_cast<std::uint64_t>(first_), .step = n, .purpose = noise_purpose::momenta},
        normals_);
    const double root = std::sqrt(temperature);
    for (std::size_t i = 0; i < size; ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      x_.p[k] = normals_[i] * (root * root_mass(system, k));
    }
    const T before = kinetic_energy<T>(system, x_.p) + potential_;
    auto run = stepper.open(x_);
    stepper.advance(run, steps);
    auto proposal = stepper.synchronous(run);
    const T potential = system.potential(proposal.q);
    const T after = kinetic_energy<T>(system, proposal.p) + potential;
    bool all = true;
    std::array<bool, lanes_in<T>> accepts{};
    for (int k = 0; k < count_; ++k) {
      const double rise = (lane(after, k) - lane(before, k)) / temperature;
      const double z1 = lane(normals_[size], k);
      const double z2 = lane(normals_[size + 1], k);
      // -log of a uniform number is half the square of two normal ones. What is not a number is rejected.
      accepts[static_cast<std::size_t>(k)] = rise < 0.5 * (z1 * z1 + z2 * z2);
      all = all && accepts[static_cast<std::size_t>(k)];
      chain_sums& sums = sums_[static_cast<std::size_t>(k)];
      sums.last = std::isfinite(rise) ? std::min(1.0, std::exp(-rise)) : 0.0;
      sums.acceptance += sums.last;
      sums.squares += rise * rise;
      if (!std::isfinite(rise)) sums.diverged += 1.0;
    }
    if (all) {
      std::swap(x_.q, proposal.q);
      potential_ = potential;
      return;
    }
    for (int k = 0; k < count_; ++k) {
      if (!accepts[static_cast<std::size_t>(k)]) continue;
      for (Eigen::Index i = 0; i < x_.q.size(); ++i) set_lane(x_.q[i], k, lane(proposal.q[i], k));
      set_lane(potential_, k, lane(potential, k));
    }
  }

  std::int64_t first() const { return first_; }
  int count() const { return count_; }
  Eigen::VectorXd position(int k) const { return lane(x_.q, k); }
  double potential(int k) const { return lane(potential_, k); }
  const chain_sums& sums(int k) const { return sums_[static_cast<std::size_t>(k)]; }
  void forget_sums() { sums_.assign(sums_.size(), {}); }

  /// All that chain k must remember, as numbers in `row`, or from there.
  void pass(int k, saved_numbers& row) {
    const auto pass_lane = [&](T& all) {
      double one = lane(all, k);
      row.pass(one);
      set_lane(all, k, one);
    };
    for (T& x : x_.q) pass_lane(x);
    pass_lane(potential_);
    sums_[static_cast<std::size_t>(k)].pass(row);
  }

 private:
  void evaluate(const model& system) { potential_ = system.potential(x_.q); }

  std::int64_t first_;
  int count_;
  phase_point<T, Eigen::Dynamic> x_;
  T potential_{0.0};
  std::vector<T> normals_;
  std::vector<chain_sums> sums_;
};

// The course of Hybrid Monte Carlo: burn-in, masses, draws, and states to go on from.

/// The number of steps of trajectory n of all chains: durations are uniform.
inline std::int64_t steps_of(const hmc_options& options, std::int64_t trajectory, double length,
                             double step) {
  std::array<double, 1> normal{};
  standard_normals<double>(options.seed, {.step = trajectory, .purpose = noise_purpose::duration}, normal);
  return std::max<std::int64_t>(1, std::llround(2.0 * uniform_by_normal(normal[0]) * length / step));
}

/// Chains in lanes of T.
template <class T>
class sampler {
 public:
  sampler(const model& system, const nysalt::method& method, const initial_states& starts,
          const hmc_options& options)
      : system_(system),
        target_(system),
        method_(method),
        options_(options),
        mine_(options.chains, *options.execution.ranks),
        report_(progress_of_share(*options.execution.ranks, mine_.count() * (options.burn_in + options.draws),
                                  options.chains * (options.burn_in + options.draws),
                                  options.execution.progress)) {
    result_.step = options.step;
    const std::int64_t blocks = (mine_.count() + lanes_in<T> - 1) / lanes_in<T>;
    blocks_.resize(static_cast<std::size_t>(blocks));
    for_each_block_of_chains([&](const model& own, auto& block, std::int64_t first, int count) {
      block = std::make_unique<block_of_chains<T>>(own, starts, options.seed, first, count);
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
      for_each_block_of_chains(
          [&](const model& own, auto& block, std::int64_t, int) { draw(own, *block, next, take); });
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
  void for_each_block_of_chains(const auto& body) {
    const auto visit = [&](const model& own, std::int64_t first, int count) {
      body(own, blocks_[static_cast<std::size_t>((first - mine_.first()) / lanes_in<T>)], first, count);
    };
    for_each_lane_block(target_, mine_, lanes_in<T>, {.threads = options_.execution.threads}, visit);
  }

  double evaluations(double trajectories, double steps) const {
    const nysalt::word& word = method_.letters();
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
    for_each_block_of_chains([&](const model& own, auto& block, std::int64_t, int) {
      block->propose(make_stepper(own, method_, result_.step), options_.temperature, options_.seed, n, steps);
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

  /// Trajectories done_ .. next - 1.
  void draw(const model& own, block_of_chains<T>& block, std::int64_t next,
            const std::function<void(const hmc_draw&)>& take) {
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
  /// Saves all that the chains of this rank, and what they share, must remember; or restores it.
  void pass(std::span<double> numbers, bool restores) {
    saved_numbers shared(numbers.first(width_of_head()), restores);
    for (double* x : {&result_.step, &steps_, &steps_of_burn_in_}) shared.pass(*x);
    auto memory = tuned_ ? tuned_->saved() : dual_averaging::memory{};
    for (double& x : memory) shared.pass(x);
    if (tuned_) tuned_->restore(memory);
    if (options_.diagonal_masses && done_ > options_.burn_in / 2) {
      Eigen::VectorXd deviations = Eigen::VectorXd::Zero(size(system_));
      std::ranges::copy(result_.deviations, deviations.begin());
      for (double& x : deviations) shared.pass(x);
      if (restores) use_deviations(deviations);
    }
    std::size_t m = 0;
    for (auto& block : blocks_) {
      for (int k = 0; k < block->count(); ++k, ++m) {
        const std::size_t chain = static_cast<std::size_t>(block->first() + k);
        saved_numbers row(numbers.subspan(width_of_head() + chain * width_of_row(), width_of_row()),
                          restores);
        block->pass(k, row);
        if (options_.diagonal_masses) seen_[m].pass(size(system_), row);
      }
    }
  }

  hmc_state state() {
    const std::size_t head = width_of_head();
    const std::size_t width = width_of_row();
    hmc_state result{done_, std::vector<double>(head + static_cast<std::size_t>(options_.chains) * width)};
    pass(result.numbers, false);
    std::vector<std::size_t> first_of_rank;
    for (int r = 0; r <= options_.execution.ranks->size(); ++r)
      first_of_rank.push_back(head + static_cast<std::size_t>(mine_.first_of(r)) * width);
    first_of_rank.front() = 0;  // the head is of rank 0
    all_gather_items(*options_.execution.ranks, result.numbers, first_of_rank);
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
    pass(numbers, true);
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
  const nysalt::method& method_;
  const hmc_options& options_;
  shard mine_;
  progress_callback report_;
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
