// SPDX-License-Identifier: BSL-1.0
// Hybrid Monte Carlo: chains in lanes, on threads and ranks.
#include "nysalt/hmc.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "dual_averaging.hpp"
#include "metropolis.hpp"
#include "nysalt/detail/ensemble_loop.hpp"
#include "nysalt/detail/progress_of_share.hpp"
#include "nysalt/detail/sentence.hpp"
#include "nysalt/detail/together.hpp"
#include "nysalt/noises/counter_based.hpp"
#include "nysalt/shard.hpp"
#include "nysalt/stepper.hpp"
#include "rescaled.hpp"

namespace nysalt {

namespace {

/// What one chain adds up.
struct chain_sums {
  double acceptance = 0.0;
  double squares = 0.0;  // of (H' - H)/kT
  std::int64_t diverged = 0;
  double last = 0.0;  // acceptance of the last trajectory
};

/// Where the draws of a chain vary, by Welford's recurrence.
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
};

/// The number of steps of trajectory n of all chains: durations are uniform.
std::int64_t steps_of(const hmc_options& options, std::int64_t trajectory, double length, double step) {
  std::array<double, 1> normal{};
  standard_normals<double>(options.seed, {.step = trajectory, .purpose = noise_purpose::duration}, normal);
  const double uniform = 0.5 * std::erfc(-normal[0] / std::numbers::sqrt2);
  return std::max<std::int64_t>(1, std::llround(2.0 * uniform * length / step));
}

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
          "hmc: the potential and the force must be finite at a start, and at start {} the potential is {}; "
          "take other starts",
          first + k, lane(potential_, k)));
    }
  }

  /// From now on positions are q/s.
  void rescale(const Eigen::VectorXd& scales) {
    for (Eigen::Index i = 0; i < scales.size(); ++i) x_.q[i] = x_.q[i] * (1.0 / scales[i]);
  }

  /// Trajectory number n, of so many steps.
  void propose(const stepper<model, run_time_word>& stepper, double temperature, std::uint64_t seed,
               std::int64_t n, std::int64_t steps) {
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
      x_.p[k] = normals_[i] * (root * system.root_mass(k));
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
      if (!std::isfinite(rise)) ++sums.diverged;
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

 private:
  void evaluate(const model& system) { potential_ = system.potential(x_.q); }

  std::int64_t first_;
  int count_;
  phase_point<T, Eigen::Dynamic> x_;
  T potential_{0.0};
  std::vector<T> normals_;
  std::vector<chain_sums> sums_;
};

void require_options(const model& system, const hmc_options& options) {
  const auto positive = [](const char* name, double value) {
    if (value > 0.0 && std::isfinite(value)) return;
    throw std::invalid_argument(sentence("hmc: {} must be positive and finite, got {}", name, value));
  };
  positive("step", options.step);
  positive("length", options.length);
  const auto at_least = [](const char* name, std::int64_t value, std::int64_t least) {
    if (value >= least) return;
    throw std::invalid_argument(sentence("hmc: {} must be at least {}, got {}", name, least, value));
  };
  at_least("chains", options.chains, 1);
  at_least("draws", options.draws, 1);
  at_least("burn_in", options.burn_in, options.acceptance || options.diagonal_masses ? 100 : 0);
  at_least("threads", options.threads, 1);
  if (options.diagonal_masses && !options.acceptance) {
    throw std::invalid_argument(
        "hmc: diagonal_masses change the unit of time, and with it the step: ask for an acceptance, to which "
        "the step is tuned");
  }
  if (options.acceptance && !(*options.acceptance > 0.0 && *options.acceptance < 1.0)) {
    throw std::invalid_argument(
        sentence("hmc: acceptance must be between 0 and 1, got {}", *options.acceptance));
  }
  if (!has_quadratic_kinetic(system)) {
    throw std::invalid_argument(sentence(
        "hmc: the kinetic energy of {} must be quadratic in p, as momenta are drawn from a normal law",
        describe(system)));
  }
  if (!has_potential(system)) {
    throw std::invalid_argument(
        sentence("hmc: {} must tell its potential, by which proposals are accepted; add potential(q)",
                 describe(system)));
  }
}

/// Large systems are stepped one chain after the other, as loops over coordinates fill the lanes then.
bool has_room_for_lanes(const model& system) {
  constexpr Eigen::Index most = 512;
  return system.facts().in_lanes && size(system) <= most;
}

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
        tell_(progress_of_share(*options.ranks, mine_.count() * (options.burn_in + options.draws),
                                options.chains * (options.burn_in + options.draws), options.progress)) {
    result_.step = options.step;
    const std::int64_t blocks = (mine_.count() + lanes_in<T> - 1) / lanes_in<T>;
    blocks_.resize(static_cast<std::size_t>(blocks));
    together(*options.ranks, [&] {
      for_each_block([&](std::size_t b, std::int64_t first, int count) {
        blocks_[b] = std::make_unique<block_of_chains<T>>(detail::own_copy(system), starts, options.seed,
                                                          first, count);
      });
    });
  }

  hmc_result run(const std::function<void(const hmc_draw&)>& take) {
    burn_in();
    for (auto& block : blocks_) block->forget_sums();
    const double steps_before = steps_;
    for (std::int64_t n = 0; n < options_.draws; ++n) count_steps(options_.burn_in + n);
    together(*options_.ranks,
             [&] { for_each_block([&](std::size_t b, std::int64_t, int) { draw(*blocks_[b], take); }); });
    const double of_draws = static_cast<double>(options_.draws);
    result_.evaluations_of_draw = evaluations(of_draws, steps_ - steps_before) / of_draws;
    result_.evaluations_of_burn_in = evaluations(static_cast<double>(options_.burn_in), steps_before);
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
    const auto per_step = detail::evaluations_of(system_, word.evaluations_per_step, word.force_derivatives);
    return trajectories * (word.evaluations_to_open + word.evaluations_to_look) +
           steps * static_cast<double>(per_step);
  }
  /// Before masses are known nothing tells how long a trajectory should be: some steps.
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

  /// All chains together, as they share the step that is tuned.
  void burn_in() {
    const std::int64_t half = options_.burn_in / 2;
    std::optional<detail::dual_averaging> tuned;
    const auto begin_tuning = [&] {
      if (options_.acceptance) tuned.emplace(result_.step, *options_.acceptance);
    };
    begin_tuning();
    std::vector<moments> seen(options_.diagonal_masses ? static_cast<std::size_t>(mine_.count()) : 0);
    for (std::int64_t n = 0; n < options_.burn_in; ++n) {
      if (options_.diagonal_masses && n == half) {
        take_masses(seen);
        result_.step = 1.0;
        begin_tuning();
      }
      if (tuned)
        result_.step = is_before_masses(n) ? tuned->step() : std::min(tuned->step(), options_.length);
      const std::int64_t steps = count_steps(n);
      together(*options_.ranks, [&] {
        for_each_block([&](std::size_t b, std::int64_t, int) { go_on(*blocks_[b], n, steps); });
      });
      if (tuned) tuned->take(acceptance_of_last());
      if (!seen.empty() && n >= half / 2 && n < half) watch(seen);
      if (tell_) tell_((n + 1) * mine_.count());
    }
    if (tuned) result_.step = std::min(tuned->settled(), options_.length);
  }

  void go_on(block_of_chains<T>& block, std::int64_t n, std::int64_t steps) {
    const model own = detail::own_copy(target_);
    const auto stepper = make_stepper(own, method_, result_.step);
    block.propose(stepper, options_.temperature, options_.seed, n, steps);
  }

  void draw(block_of_chains<T>& block, const std::function<void(const hmc_draw&)>& take) {
    const model own = detail::own_copy(target_);
    const auto stepper = make_stepper(own, method_, result_.step);
    for (std::int64_t n = 0; n < options_.draws; ++n) {
      const std::int64_t trajectory = options_.burn_in + n;
      block.propose(stepper, options_.temperature, options_.seed, trajectory,
                    steps_of(options_, trajectory, options_.length, result_.step));
      for (int k = 0; k < block.count(); ++k) {
        Eigen::VectorXd q = block.position(k);
        if (scales_.size() > 0) q = q.cwiseProduct(scales_);
        take({block.first() + k, n, q, block.potential(k)});
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

  void watch(std::vector<moments>& seen) const {
    std::size_t m = 0;
    for (const auto& block : blocks_) {
      for (int k = 0; k < block->count(); ++k) seen[m++].take(block->position(k));
    }
  }

  /// Variances over all chains, about the mean of all.
  void take_masses(const std::vector<moments>& seen) {
    const Eigen::VectorXd zero = Eigen::VectorXd::Zero(size(system_));
    std::vector<Eigen::VectorXd> means;
    for (const auto& one : seen) means.push_back(one.mean);
    const Eigen::VectorXd mean = mine_.sum(means, zero) / static_cast<double>(options_.chains);
    std::vector<Eigen::VectorXd> squares;
    for (const auto& one : seen) squares.push_back(one.squares / one.count + (one.mean - mean).cwiseAbs2());
    const Eigen::VectorXd variance = mine_.sum(squares, zero) / static_cast<double>(options_.chains);
    Eigen::Index still = 0;
    if (!(variance.minCoeff(&still) > 0.0)) {
      throw std::runtime_error(sentence(
          "hmc: coordinate {} did not vary in the burn-in, and has no mass of its own; take a smaller step, "
          "a longer burn-in, or no diagonal_masses",
          still + 1));
    }
    const Eigen::VectorXd deviations = variance.cwiseSqrt();
    result_.deviations.assign(deviations.begin(), deviations.end());
    scales_ = deviations / std::sqrt(options_.temperature);  // of coordinates in which omega is one
    target_ = model(detail::rescaled(system_, scales_));
    for (auto& block : blocks_) block->rescale(scales_);
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
        diverged.push_back(static_cast<double>(sums.diverged));
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
  std::function<void(std::int64_t)> tell_;
  std::vector<std::unique_ptr<block_of_chains<T>>> blocks_;
  hmc_result result_;
  Eigen::VectorXd scales_;  // with `diagonal_masses`, positions are these times those that are stepped
  double steps_ = 0.0;      // of one chain so far
};

}  // namespace

hmc_result hmc(const model& system, const tabulated& method, const initial_states& starts,
               const hmc_options& options, const std::function<void(const hmc_draw&)>& take) {
  detail::require_metropolis_applies("hmc", system, method, options.temperature);
  require_options(system, options);
  if (has_room_for_lanes(system)) {
    return sampler<detail::lanes>(system, method, starts, options).run(take);
  }
  return sampler<double>(system, method, starts, options).run(take);
}

}  // namespace nysalt
