// SPDX-License-Identifier: BSL-1.0
// Acceptance of trajectories as proposals of Hybrid Monte Carlo.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "nysalt/analysis/statistics.hpp"
#include "nysalt/analysis/trajectory_errors.hpp"
#include "nysalt/execution.hpp"
#include "nysalt/initial_states.hpp"
#include "nysalt/method.hpp"
#include "nysalt/model.hpp"

namespace nysalt {

/// Acceptance of proposals, and their cost.
struct acceptance_result {
  estimate probability;                          ///< mean over all trajectories
  std::vector<double> of_each;                   ///< probability of each trajectory; 0 if it diverged
  std::vector<diverged_trajectory> diverged_at;  ///< steps of divergence, in the order of the states
  double evaluations_per_time = 0.0;             ///< force evaluations per unit time, start-up included
};

/// The probability that Metropolis' rule accepts where a trajectory of n steps leads
/// [duane_kennedy_pendleton_roweth_1987],
///
///   mean over trajectories of min(1, exp(-(H(x_n) - H(x_0))/kT)),
///
/// with H at the two ends only. A trajectory that diverged is a rejected one. The rule keeps the density
/// exp(-H/kT) if the map is reversible and keeps volume, so that only symmetric methods are taken, and only
/// kinetic energies that are even: else p -> -p does not turn the motion around. The
/// number is the acceptance of a sampler at work if the starts have that density. Neither lanes, threads nor
/// ranks change a bit, and all ranks get the result.
///
/// Memory: 32 bytes a trajectory on each rank. Throws std::invalid_argument if the method is not symmetric,
/// K(-p) is not K(p) at some start of the first 16, H cannot be evaluated, the system is in a bath that acts
/// (H is not its own then), kT is not positive and finite, there is not one step or trajectory, or a start
/// does not fit.
acceptance_result acceptance(const model& system, const nysalt::method& method,
                             const initial_states& ensemble, const trajectory_options& options,
                             double temperature = 1.0);

// The step at which proposals of Hybrid Monte Carlo are accepted with a given probability.

/// Options of the acceptance of proposals.
struct proposal_options {
  double length;                  ///< mean duration: durations are uniform between 0 and twice that
  double temperature = 1.0;       ///< kT, an energy
  double times_larger = 1.0;      ///< size of the system that will run, as a multiple of this system
  std::int64_t states = 100;      ///< states at which proposals begin
  std::uint64_t seed = 1;         ///< seed of the states
  nysalt::execution execution{};  ///< progress counts the states of each step that is tried
};

namespace detail {

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
/// steps of each state one step of the word, and one potential.
proposal_acceptance acceptance_of_proposals(const model& system, const nysalt::method& method, double step,
                                            const initial_states& states, const proposal_options& options);

}  // namespace detail

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
acceptance_step step_at_acceptance(const model& system, const std::function<method(double step)>& method_at,
                                   double acceptance, double guess, const initial_states& states,
                                   const proposal_options& options);

// Acceptance of Hybrid Monte Carlo where forces are linear, in closed form.

namespace detail {

/// The acceptance of Metropolis' rule where the energy error of proposals, over kT, is normal with the mean
/// mu: erfc(sqrt(mu)/2), that is 2 Phi(-sqrt(mu/2)) [calvo_sanz_alonso_sanz_serna_2021]. As exp(-error) has
/// the mean 1 the variance is 2 mu. That is the limit of many dimensions; of one oscillator the distribution
/// is another.
double acceptance_at(double energy_error);

}  // namespace detail

/// The mean energy error of an acceptance: the inverse of acceptance_at(). Throws std::invalid_argument
/// unless 0 < acceptance < 1.
double energy_error_at(double acceptance);

namespace detail {

/// The mean of (H' - H)/kT over proposals of random duration on oscillators of these frequencies, from their
/// canonical distribution: half the sum of energy_error_on_oscillator() at h omega, as sin^2 is 1/2 on
/// average. It is exact as trajectories become long. Infinite where the method is not stable on one of them.
/// Throws std::invalid_argument if the method is not symmetric, and what energy_error_on_oscillator() throws.
/// Cost: one energy_error_on_oscillator() for each frequency.
double gaussian_energy_error(const method& method, std::span<const double> frequencies, double step);

}  // namespace detail

/// The step up to which proposals are accepted with this probability: from `from` it grows by 2 % at a time
/// until the acceptance falls below it, or shrinks until it does not, and what lies between is halved. Where
/// none is given, `from` is a hundredth of a radian of the fastest oscillator. Words that are learned for a
/// step may be accepted less often at smaller ones: begin at theirs. Throws what gaussian_energy_error()
/// throws, and std::invalid_argument if no frequency is positive, or no step down to that hundredth is
/// accepted so often. Cost: some hundred calls of gaussian_energy_error().
double gaussian_step(const nysalt::method& method, std::span<const double> frequencies, double acceptance,
                     double from = 0.0);

}  // namespace nysalt
