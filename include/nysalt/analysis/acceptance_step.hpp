// SPDX-License-Identifier: BSL-1.0
// The step at which proposals of Hybrid Monte Carlo are accepted with a given probability.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "nysalt/analysis/statistics.hpp"
#include "nysalt/communicators/one_rank.hpp"
#include "nysalt/initial_states.hpp"
#include "nysalt/methods/tabulated.hpp"
#include "nysalt/model.hpp"

namespace nysalt {

/// Options of the acceptance of proposals.
struct proposal_options {
  double length;                          ///< mean duration: durations are uniform between 0 and twice that
  double temperature = 1.0;               ///< kT, an energy
  double times_larger = 1.0;              ///< size of the system that will run, as a multiple of this system
  std::int64_t states = 100;              ///< states at which proposals begin
  std::uint64_t seed = 1;                 ///< seed of the states
  int threads = 1;                        ///< changes no bit
  const communicator* ranks = &one_rank;  ///< ranks that share the states; changes no bit
};

/// Acceptance of proposals at a step.
struct proposal_acceptance {
  estimate probability;         ///< probability over all states and durations
  std::vector<double> of_each;  ///< contribution of each state; the mean is the probability
};

/// The mean over states and durations of the probability that Metropolis' rule accepts, from one trajectory
/// of each state, along which every duration is seen. States must be of exp(-H/kT).
///
/// Where the system that will run is larger, energy errors add up over its parts: the mean of (H' - H)^2
/// after n steps grows with the size, and 2 mu of acceptance_at() is that many times the one of this system.
/// `of_each` is linearised about the mean then.
///
/// Throws std::invalid_argument if the method is not symmetric, the system is in a bath that acts, has no
/// potential or a kinetic energy that is not quadratic, an option is out of range, or a trajectory has more
/// than 100,000 steps. Memory: 8 bytes for each step of each state. Cost: for each step of 2 length/step
/// steps of each state that of the word, and one potential.
proposal_acceptance acceptance_of_proposals(const model& system, const tabulated& method, double step,
                                            const initial_states& states, const proposal_options& options);

/// A step with a standard error.
struct acceptance_step {
  double step;                      ///< step with the requested acceptance
  estimate log_step;                ///< logarithm of the step, with the standard error over states
  std::vector<double> log_of_each;  ///< contribution of each state to the logarithm; the mean is log_step
  bool is_longest = false;          ///< even trajectories of one step are accepted more often than asked
};

/// The step up to which proposals are accepted with a probability: it grows, by a seventh at a time, from
/// `guess` or from a smaller one until the acceptance falls below, and is interpolated then; at most
/// `length`. method_at(step) is the method at a step; a std::invalid_argument that it throws means that there
/// is none. With the same options all methods see the same states, so that differences of log_of_each are of
/// pairs. Throws what acceptance_of_proposals() throws, std::invalid_argument unless 0 < acceptance < 1, and
/// std::runtime_error if no step down to a thousandth of the guess is accepted so often.
acceptance_step step_at_acceptance(const model& system,
                                   const std::function<tabulated(double step)>& method_at, double acceptance,
                                   double guess, const initial_states& states,
                                   const proposal_options& options);

}  // namespace nysalt
