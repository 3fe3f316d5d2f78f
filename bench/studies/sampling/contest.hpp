// SPDX-License-Identifier: BSL-1.0
// Words on a target: their steps at an acceptance, learning them, and what a low error costs.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "low_error.hpp"
#include "nysalt/hmc.hpp"

namespace nysalt::sampling_benchmark {

/// What is sampled, at kT = 1, from starts that are of its law.
struct target {
  model system;
  initial_states starts;
};

struct contest_options {
  double length;            // mean duration of a trajectory
  std::int64_t pilot = 24;  // draws of each of four chains by which a step is judged
  int threads = 2;
};

/// Root mean square of H' - H where an accepted share of 0.9 is expected: H' - H is normal with the mean
/// s^2/2 and the variance s^2 in many dimensions, and erfc(s/sqrt 8) are accepted
/// [beskos_and_others_2013].
double energy_error_at(double acceptance);

/// The largest step near a guess at which the root mean square of H' - H is below `wanted`: from above by
/// steps of 6 %, then by halves to 1 %.
double step_with_error(const target& of, const method& word, double guess, double wanted,
                       const contest_options& options);

/// A target that is fitted on, and how many times as large the one is that will be sampled.
struct small_target {
  target of;
  double ratio;
};

/// The step for a large target, foretold on the small one, as the variance of H' - H is extensive.
double foretold_step(const small_target& small, const method& word, double guess,
                     const contest_options& options);

/// A word and the step that it was learned at.
struct learned_word {
  method word;
  double step;
};

/// The family bab of 2 to 6 drifts, learned by the loss `acceptance` at steps around a guess, 12 %
/// apart: of the words that are foretold to have an acceptance of 0.9 at their own step, that of the largest.
/// The name has a mark where the fit was not usable.
learned_word learned_bab(int drifts, const small_target& small, double guess, const contest_options& options);

/// What chains of a word cost.
struct outcome {
  double step = 0.0;
  double acceptance = 0.0;
  double evaluations_of_draw = 0.0;
  estimate to_mean_error{};           // evaluations of a chain, with the bootstrap's standard error
  estimate to_largest_error{};        // the same
  std::vector<double> mean_errors{};  // the median of the chains, draw after draw
};

/// Four chains with a step.
outcome run_chains(const target& of, const method& word, double step, const statistic& measured,
                   std::int64_t draws, const contest_options& options);

/// The final positions of chains, as starts of the law that they have reached.
initial_states reached_by(const target& of, const method& word, double step, std::int64_t chains,
                          std::int64_t burn_in, std::int64_t draws, const contest_options& options);

}  // namespace nysalt::sampling_benchmark
