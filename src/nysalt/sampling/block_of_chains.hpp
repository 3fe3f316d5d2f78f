// SPDX-License-Identifier: BSL-1.0
// Chains of Hybrid Monte Carlo side by side in lanes, and what each of them adds up.
#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "moments.hpp"
#include "nysalt/detail/sentence.hpp"
#include "nysalt/initial_states.hpp"
#include "nysalt/model.hpp"
#include "nysalt/noises/counter_based.hpp"
#include "nysalt/stepper.hpp"

namespace nysalt::detail {

/// Sums of one chain.
struct chain_sums {
  double acceptance = 0.0;
  double squares = 0.0;  // of (H' - H)/kT
  double diverged = 0.0;
  double last = 0.0;  // acceptance of the last trajectory

  static constexpr Eigen::Index width = 4;  // numbers that are saved
  void write(saved_numbers& row) const {
    for (const double x : {acceptance, squares, diverged, last}) row.put(x);
  }
  void read(saved_numbers& row) {
    for (double* x : {&acceptance, &squares, &diverged, &last}) *x = row.get();
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
  void write(int k, saved_numbers& row) const {
    for (Eigen::Index i = 0; i < x_.q.size(); ++i) row.put(lane(x_.q[i], k));
    row.put(lane(potential_, k));
    sums(k).write(row);
  }
  void read(int k, saved_numbers& row) {
    for (Eigen::Index i = 0; i < x_.q.size(); ++i) set_lane(x_.q[i], k, row.get());
    set_lane(potential_, k, row.get());
    sums_[static_cast<std::size_t>(k)].read(row);
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

}  // namespace nysalt::detail
