// SPDX-License-Identifier: BSL-1.0
// How often a trajectory would be accepted as a proposal of Hybrid Monte Carlo.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <stdexcept>
#include <vector>

#include "nysalt/analysis/evaluations.hpp"
#include "nysalt/analysis/method_error.hpp"
#include "nysalt/analysis/trajectory_errors.hpp"
#include "nysalt/detail/sentence.hpp"
#include "nysalt/energy.hpp"
#include "nysalt/integrate_ensemble.hpp"
#include "nysalt/shard.hpp"

namespace nysalt {

/// How often proposals are accepted, and what they cost.
struct acceptance_result {
  estimate probability;                          ///< mean over all trajectories
  std::vector<double> of_each;                   ///< probability of each trajectory; 0 if it diverged
  std::vector<diverged_trajectory> diverged_at;  ///< in their order
  double evaluations_per_time = 0.0;             ///< force evaluations per unit time, start-up included
};

namespace detail {

/// K(-p) = K(p) and grad K(-p) = -grad K(p), at the momenta of start number m.
template <SeparableSystem S>
void require_even_kinetic(const S& system, const vector<double, S::dimension>& p, std::int64_t m) {
  const vector<double, S::dimension> back = -p;
  auto v = make_vector<double>(system);
  auto v_back = v;
  velocity<double>(system, p, v);
  velocity<double>(system, back, v_back);
  // An even formula has the same terms at -p: it differs by the rounding of sums, 100 operations of eps, of
  // terms that cancel to a part of 7e5.
  const double rounding = std::sqrt(std::numeric_limits<double>::epsilon());
  const double odd = (v + v_back).cwiseAbs().maxCoeff();
  const double size = v.cwiseAbs().maxCoeff();
  bool is_even = odd <= rounding * size;
  if constexpr (HasKineticEnergy<S, double>) {
    const double k = system.kinetic_energy(p);
    is_even = is_even && std::abs(k - system.kinetic_energy(back)) <= rounding * std::abs(k);
  }
  if (is_even) return;
  throw std::invalid_argument(sentence(
      "acceptance: the kinetic energy must be even, K(-p) = K(p), and at start {} it is not: with p -> -p "
      "the "
      "motion does not run back, and Hybrid Monte Carlo would sample another law; take a K that is even",
      m));
}

}  // namespace detail

/// The probability that Metropolis' rule accepts where a trajectory of n steps leads
/// [duane_kennedy_pendleton_roweth_1987],
///
///   mean over trajectories of min(1, exp(-(H(x_n) - H(x_0))/kT)),
///
/// with H at the two ends only. A trajectory that diverged is a rejected one. The rule keeps the law
/// exp(-H/kT) if the map is reversible and keeps volume, so that only symmetric methods are taken, and only
/// kinetic energies that are even: else p -> -p does not turn the motion around. What the
/// number tells of a sampler at work, it tells for starts of that law. Neither lanes, threads nor
/// ranks change a bit, and all ranks get the result.
///
/// Memory: 32 bytes a trajectory on each rank. Throws std::invalid_argument if the method is not symmetric,
/// K(-p) is not K(p) at some start of the first 16, the system is in a bath that acts (H is not its own
/// then), kT is not positive and finite, there is not one step or trajectory, or a start does not fit.
template <SeparableSystem S, Method M, Ensemble<S> E>
  requires HasEnergy<S> acceptance_result acceptance(const S& system, const M& method, const E& ensemble,
                                                     const trajectory_options& options,
                                                     double temperature = 1.0) {
    using T = scalar_of_lanes<lanes_of<S>>;
    if (!method.symmetric) {
      throw std::invalid_argument(
          sentence("acceptance: {} is not reversible, and Hybrid Monte Carlo would sample another law; take "
                   "a symmetric method",
                   method.name()));
    }
    if constexpr (HasBath<S>) {
      const bath& its = system.bath();
      if (its.acts()) {
        throw std::invalid_argument(sentence(
            "acceptance: H is not conserved in {}; take the system without its bath", describe(system)));
      }
    }
    if (!(temperature > 0.0) || !std::isfinite(temperature)) {
      throw std::invalid_argument(
          sentence("acceptance: kT must be positive and finite, got {}", temperature));
    }
    together(*options.ranks, [&] { require_room(options, 1, 1); });
    if (!has_quadratic_kinetic(system)) {
      constexpr std::int64_t enough = 16;
      for (std::int64_t m = 0; m < std::min(enough, options.trajectories); ++m) {
        detail::require_even_kinetic(system, sound_start(system, ensemble, options.seed, m).p, m);
      }
    }
    const auto stepper = make_stepper(system, method, options.step);
    std::vector<double> at_start(static_cast<std::size_t>(options.trajectories));
    std::vector<double> of_each(at_start.size(), 0.0);
    const auto read = [&](const phase_point<T, S::dimension>& x, std::span<T> number) {
      number[0] = energy_in_lanes<T>(system, x);
    };
    const auto take = [&](std::int64_t m, std::int64_t n, std::span<const double> energy) {
      const auto slot = static_cast<std::size_t>(m);
      if (n == 0) {
        at_start[slot] = energy[0];
      } else {
        const double rise = energy[0] - at_start[slot];
        of_each[slot] = rise <= 0.0 ? 1.0 : std::exp(-rise / temperature);
      }
    };
    const ensemble_options both_ends{.trajectories = options.trajectories,
                                     .steps = options.steps,
                                     .every = options.steps,
                                     .seed = options.seed,
                                     .threads = options.threads,
                                     .progress = options.progress,
                                     .ranks = options.ranks};
    const auto diverged = integrate_ensemble<T>(stepper, ensemble, both_ends, 1, read, take);
    shard(options.trajectories, *options.ranks).gather(of_each);

    acceptance_result result{mean_and_error(of_each), of_each, {}};
    for (std::size_t m = 0; m < diverged.size(); ++m) {
      if (diverged[m]) result.diverged_at.push_back({static_cast<std::int64_t>(m), *diverged[m]});
    }
    const auto evaluations =
        evaluations_of_run(system, method, options.step, options.steps, ensemble(options.seed, 0));
    const double time = static_cast<double>(options.steps) * std::abs(options.step);
    result.evaluations_per_time = static_cast<double>(evaluations) / time;
    return result;
  }

}  // namespace nysalt
