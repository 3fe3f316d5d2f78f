// SPDX-License-Identifier: BSL-1.0
// Acceptance of trajectories as proposals of Hybrid Monte Carlo.
#pragma once

#include <vector>

#include "nysalt/analysis/statistics.hpp"
#include "nysalt/analysis/trajectory_options.hpp"
#include "nysalt/initial_states.hpp"
#include "nysalt/methods/tabulated.hpp"
#include "nysalt/model.hpp"

namespace nysalt {

/// Acceptance of proposals, and their cost.
struct acceptance_result {
  estimate probability;                          ///< mean over all trajectories
  std::vector<double> of_each;                   ///< probability of each trajectory; 0 if it diverged
  std::vector<diverged_trajectory> diverged_at;  ///< steps of divergence, in the order of the states
  double evaluations_per_time = 0.0;             ///< force evaluations per unit time, start-up included
};

namespace detail {
acceptance_result acceptance(const model& system, const tabulated& method, const initial_states& ensemble,
                             const trajectory_options& options, double temperature);
}  // namespace detail

/// The probability that Metropolis' rule accepts where a trajectory of n steps leads
/// [duane_kennedy_pendleton_roweth_1987],
///
///   mean over trajectories of min(1, exp(-(H(x_n) - H(x_0))/kT)),
///
/// with H at the two ends only. A trajectory that diverged is a rejected one. The rule keeps the density
/// exp(-H/kT) if the map is reversible and keeps volume, so that only symmetric methods are taken, and only
/// kinetic energies that are even: else p -> -p does not turn the motion around. The
/// number is that of a sampler at work if the starts have that density. Neither lanes, threads nor
/// ranks change a bit, and all ranks get the result.
///
/// Memory: 32 bytes a trajectory on each rank. Throws std::invalid_argument if the method is not symmetric,
/// K(-p) is not K(p) at some start of the first 16, the system is in a bath that acts (H is not its own
/// then), kT is not positive and finite, there is not one step or trajectory, or a start does not fit.
template <SeparableSystem S, Method M, Ensemble<S> E>
  requires HasEnergy<S>
acceptance_result acceptance(const S& system, const M& method, const E& ensemble,
                             const trajectory_options& options, double temperature = 1.0) {
  return detail::acceptance(system, detail::table_for(method, system, options.step), ensemble, options,
                            temperature);
}

}  // namespace nysalt
