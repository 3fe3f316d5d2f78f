// SPDX-License-Identifier: BSL-1.0
// Hybrid Monte Carlo with any reversible word.
#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "nysalt/analysis/statistics.hpp"
#include "nysalt/execution.hpp"
#include "nysalt/initial_states.hpp"
#include "nysalt/method.hpp"
#include "nysalt/model.hpp"

namespace nysalt {

/// Chains between two trajectories: all that `hmc` needs to go on to the same bits, for any number of
/// ranks, threads and lanes.
struct hmc_state {
  std::int64_t trajectories = 0;  ///< trajectories of each chain so far, burn-in included
  std::vector<double>
      numbers{};  ///< positions, sums, the step and the state of the tuning; for `hmc` only to read
};

/// Options of chains.
struct hmc_options {
  double step;    ///< h of a whole word; a first guess where `acceptance` is asked for
  double length;  ///< mean duration of a trajectory: durations are uniform between 0 and twice that
  double temperature = 1.0;     ///< kT, an energy: exp(-V/kT) is sampled
  std::int64_t chains = 4;      ///< independent ones
  std::int64_t burn_in = 1000;  ///< trajectories of a chain before the first draw
  std::int64_t draws = 1000;    ///< trajectories of a chain after that
  std::optional<double> acceptance =
      {};  ///< acceptance to which the burn-in tunes the step, up to `length`; none: it stays
  /// Whether momenta get the masses kT/var(q_i), with variances from the first half of the burn-in. In the
  /// unit of time of these masses, which step and length are in, coordinates that do not depend on each other
  /// have the frequency 1. Needs `acceptance`.
  bool diagonal_masses = false;
  std::uint64_t seed = 1;         ///< seed of starts and chains
  nysalt::execution execution{};  ///< ranks share the chains; progress counts trajectories of all chains
  std::int64_t keep_every = 0;  ///< trajectories of a chain between two calls of `keep`; 0: it is not called
  std::function<void(const hmc_state&)> keep =
      {};  ///< checkpoint callback, at every rank, after all draws of the trajectories so far were taken
  const hmc_state* from = nullptr;  ///< a kept state of the same options to go on from; none: the starts
};

/// One draw of a chain. Refers to memory that the next draw overwrites.
struct hmc_draw {
  std::int64_t chain;        ///< number of the chain
  std::int64_t number;       ///< number of the draw in its chain, from 0 on
  const Eigen::VectorXd& q;  ///< the position
  double potential;          ///< V(q)
};

/// Result of chains.
struct hmc_result {
  double step = 0.0;                ///< h that the draws were made with
  estimate acceptance;              ///< mean over chains of the probability to be accepted
  estimate square_of_energy_error;  ///< mean over chains of (H' - H)^2/kT^2; NaN where a trajectory diverged
  std::int64_t diverged = 0;  ///< trajectories of all chains whose energy was not finite, burn-in left out
  double evaluations_of_draw = 0;     ///< force evaluations of one draw, in the mean
  double evaluations_of_burn_in = 0;  ///< force evaluations of the burn-in of one chain
  std::vector<double>
      deviations{};  ///< standard deviations of the positions, where `diagonal_masses` are asked for
};

/// Draws from exp(-V/kT) by Hybrid Monte Carlo [duane_kennedy_pendleton_roweth_1987]: fresh momenta, a
/// trajectory of random duration, Metropolis' rule. Chain m begins at the position of start m. The
/// distribution is exact for every reversible word that keeps volume, at any step. Durations are common to
/// all chains, so that chains go side by side in lanes; given them, chains are independent.
///
/// The step is tuned by dual averaging [hoffman_gelman_2014, section 3.2] of the acceptance of all chains.
/// `take` gets every draw after the burn-in, the draws of a chain in their order, of several chains at a time
/// from several threads; each rank gets the draws of its own chains. The same seed gives the same bits for
/// any number of threads, ranks and lanes.
///
/// Throws std::invalid_argument if the method is not symmetric, the kinetic energy is not quadratic in p, the
/// system is in a bath that acts or has no potential, an option is out of range, or the potential or the
/// force is not finite at a start, or the state to go on from is of other options; std::runtime_error if a
/// coordinate did not vary where its variance is asked for. Cost of a trajectory of n steps:
/// evaluations_to_open + n evaluations_per_step of the word, and one potential.
hmc_result hmc(const model& system, const method& method, const initial_states& starts,
               const hmc_options& options, const std::function<void(const hmc_draw&)>& take);

/// The factor by which the standard deviation of a scalar may still shrink if chains went on for ever,
/// split-R-hat [gelman_and_others_2013, section 11.4]: 1 where the halves of all chains agree. chains[m] has
/// the draws of chain m. NaN where there are fewer than four draws of a chain, or all are equal. Throws
/// std::invalid_argument unless all chains are of one length.
double potential_scale_reduction(const std::vector<std::vector<double>>& chains);

/// Effective number of independent draws, which would give the mean of a scalar the error that chains give:
/// all draws, over the integrated autocorrelation time of the chains together; of short or alternating
/// chains fewer, see effective_sample_size(). NaN where chains are too short.
double effective_draws(const std::vector<std::vector<double>>& chains);

}  // namespace nysalt
