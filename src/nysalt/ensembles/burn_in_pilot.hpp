// SPDX-License-Identifier: BSL-1.0
// Some chains that are watched, to learn how long they remember.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "burn_in_chains.hpp"
#include "nysalt/detail/ensemble_loop.hpp"
#include "nysalt/detail/in_digits.hpp"
#include "nysalt/detail/sentence.hpp"
#include "watched_interval.hpp"

namespace nysalt {

/// A chain ran away: the motion is not confined, or the step is too large.
struct chain_diverged : std::runtime_error {
  chain_diverged(const std::string& text, std::int64_t at) : std::runtime_error(text), step(at) {}
  std::int64_t step;  // number of the step
};

/// Chains 0, 1, ... from starts of their numbers, with noise from `first_noise` on.
template <class T>
class burn_in_pilot {
  using state = phase_point<T, Eigen::Dynamic>;
  static constexpr int width = lanes_in<T>;

  struct block {
    std::shared_ptr<const burn_in_chains> chains;
    state start;
    int count;
    lockstep<burn_in_chains::stepper_type, T> run;
  };

 public:
  /// Refers to the weights of the slowest mode, which may be empty.
  burn_in_pilot(const model& base, const initial_states& from, double temperature, double friction,
                double step, const burn_in_options& options, int count, std::int64_t first_noise,
                const Eigen::VectorXd& slowest)
      : chains_(std::make_shared<burn_in_chains>(base, temperature, friction, step, options.seed)),
        threads_(options.threads),
        count_(count),
        slowest_(&slowest) {
    for (int first = 0; first < count; first += width) {
      const int here = std::min(width, count - first);
      const state start = sound_starts<T>(base, from, options.seed, first, here);
      const auto chains = !is_black_box(base) ? chains_
                                              : std::make_shared<const burn_in_chains>(
                                                    base, temperature, friction, step, options.seed);
      blocks_.push_back({chains, start, here, chains->open(start, first_noise + first, here)});
    }
  }

  /// Goes on to step `end`, watching from here on. Throws chain_diverged, naming the first that did.
  watched_interval watch(std::int64_t end, std::int64_t every) {
    watched_interval result;
    const auto chains = static_cast<std::size_t>(count_);
    for (auto* numbers : {&result.begin, &result.mean, &result.square})
      numbers->fill(std::vector<double>(chains));
    result.force_square.assign(chains, Eigen::VectorXd());
    std::vector<double> begin(chains);
    std::vector<double> finish(chains);
    const std::int64_t before = blocks_.front().run.step();
    result.duration = static_cast<double>(end - before) * chains_->step();
    result.zero = zero_ = lane(potential_of(*blocks_.front().chains, blocks_.front().run.synchronous()), 0);
    for_each_block(count_, width, threads_, [&](std::int64_t first, int) {
      block& here = blocks_[static_cast<std::size_t>(first / width)];
      read_way(here, first, begin);
      follow(here, first, end, every, result);
      read_way(here, first, finish);
    });
    require_all_alive();
    result.way_to_begin = std::move(begin);
    result.way_to_end = mean_over_chains(finish).mean;
    return result;
  }

 private:
  /// What is watched, and then the square of each force.
  void read(const burn_in_chains& chains, const state& x, std::span<T> out) const {
    const model& system = chains.system();
    auto f = make_vector<T>(system);
    auto p = x.p;
    force<T>(system, x.q, f);
    T virial(0.0);
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      virial -= x.q[i] * f[i];
      out[watched_numbers + static_cast<std::size_t>(i)] = f[i] * f[i];
      p[i] += f[i] * (0.5 * chains_->step());
    }
    velocity<T>(system, p, f);
    T twice_kinetic(0.0);
    for (Eigen::Index i = 0; i < x.size(); ++i) twice_kinetic += p[i] * f[i];
    const double each = 1.0 / (chains_->temperature() * static_cast<double>(x.size()));
    out[0] = twice_kinetic * each;
    out[1] = virial * each;
    out[2] = (potential_of(chains, x) - zero_) * each;
    T of_mode(0.0);
    for (Eigen::Index i = 0; i < slowest_->size(); ++i) of_mode += x.q[i] * (*slowest_)[i];
    out[3] = of_mode * of_mode / chains_->temperature();
  }
  /// 0 where the system knows no potential.
  static T potential_of(const burn_in_chains& chains, const state& x) {
    const model& system = chains.system();
    return has_potential(system) ? system.kernels<T>().potential(x.q) : T(0.0);
  }

  void follow(block& here, std::int64_t first, std::int64_t end, std::int64_t every,
              watched_interval& result) {
    const std::size_t width_read = watched_numbers + static_cast<std::size_t>(here.start.size());
    std::vector<T> begin(width_read);
    std::vector<T> sum(width_read, T(0.0));
    of_watched<T> squares;
    squares.fill(T(0.0));
    read(*here.chains, here.run.synchronous(), begin);
    std::int64_t observations = 0;
    const auto observe = [&](const state& x, std::span<T> out) { read(*here.chains, x, out); };
    here.run.go_on(end, every, width_read, observe, [&](std::int64_t, std::span<const T> seen, const auto&) {
      ++observations;
      for (std::size_t i = 0; i < width_read; ++i) sum[i] += seen[i];
      for (std::size_t i = 0; i < watched_numbers; ++i) squares[i] += seen[i] * seen[i];
    });
    for (int k = 0; k < here.count; ++k) {
      const auto chain = static_cast<std::size_t>(first + k);
      const auto mean = [&](const T& of) { return lane(of, k) / static_cast<double>(observations); };
      for (std::size_t i = 0; i < watched_numbers; ++i) {
        result.begin[i][chain] = lane(begin[i], k);
        result.mean[i][chain] = mean(sum[i]);
        result.square[i][chain] = mean(squares[i]);
      }
      auto& forces = result.force_square[chain];
      forces.resize(here.start.size());
      for (Eigen::Index i = 0; i < forces.size(); ++i)
        forces[i] = mean(sum[watched_numbers + static_cast<std::size_t>(i)]);
    }
  }

  void read_way(const block& here, std::int64_t first, std::vector<double>& way) const {
    const state x = here.run.synchronous();
    T sum(0.0);
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      const T d = x.q[i] - here.start.q[i];
      sum += d * d;
    }
    for (int k = 0; k < here.count; ++k) way[static_cast<std::size_t>(first + k)] = lane(sum, k);
  }

  void require_all_alive() const {
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
      for (int k = 0; k < blocks_[b].count; ++k) {
        const auto lost = blocks_[b].run.diverged_at(k);
        if (!lost) continue;
        const std::string text = sentence(
            "gibbs: the motion of {} must be confined and the step small enough, got pilot chain {} that "
            "diverged at time {} with the step {}",
            describe(chains_->system().base()), b * width + static_cast<std::size_t>(k),
            in_digits(static_cast<double>(*lost) * chains_->step(), 6), in_digits(chains_->step(), 6));
        throw chain_diverged(text, *lost);
      }
    }
  }

  std::shared_ptr<const burn_in_chains> chains_;
  int threads_;
  int count_;
  const Eigen::VectorXd* slowest_;
  std::vector<block> blocks_;
  double zero_ = 0.0;  // of the potential: a large constant in it, or a hot start, would drown what varies
};

}  // namespace nysalt
