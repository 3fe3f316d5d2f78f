// SPDX-License-Identifier: BSL-1.0
// Distance of one step of a word from the rotation of oscillators: a loss without data.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "../losses/data_loss.hpp"
#include "nysalt/derivatives/spectrum.hpp"
#include "nysalt/flow_map_data.hpp"
#include "nysalt/learning/problem.hpp"
#include "nysalt/losses/after_steps.hpp"
#include "nysalt/losses/squares.hpp"
#include "nysalt/losses/window_error.hpp"
#include "nysalt/run_time_family.hpp"

namespace nysalt::detail {

/// The mean over frequencies of the bands of |M - R|^2 in coordinates (omega q, p), M the matrix of one step
/// and R that of the exact flow; nothing for words with rotations, which are exact on their modes. Its minima
/// are starts of a search where the step is so large that no trajectory from elsewhere stays finite. Cost:
/// some microseconds.
objective oscillator_loss(const run_time_family& family, const std::vector<frequency_band>& bands,
                          double step);

}  // namespace nysalt::detail

// Data that can be learned from, as those that came from elsewhere may not be.

namespace nysalt {

/// Throws std::invalid_argument unless the data are of this system, hold pairs of its size, all finite, and
/// trajectories that cover them; for data that came from elsewhere. What is not finite is named: coordinate,
/// pair and trajectory, all but coordinates counted from 0. Collective, if ranks share the data.
void require_valid(const flow_map_data& data, const model& system);

// A few states of data, wherever they are.

/// First states of some pairs of all ranks, by rising numbers; the same list on each rank.
phase_points starts_of(const flow_map_data& data, Eigen::Index dimension,
                       const std::vector<std::size_t>& pairs);
/// Last states of these pairs.
phase_points finishes_of(const flow_map_data& data, Eigen::Index dimension,
                         const std::vector<std::size_t>& pairs);

/// States of data, at all ranks.
struct states_of_data {
  phase_points states;  ///< typical ones, then such as are likely to be extreme
  std::size_t typical;  ///< number of the former
};

/// Starts of some hundred pairs, spread over all; then of 32 more where the force changes most, and the
/// further starts. Cost: two evaluations a pair.
states_of_data some_states(const model& system, const flow_map_data& data);

/// Starts to judge methods on: those of the data, or if they have none up to 512 states of held-out data.
phase_points judged_starts_of(const model& system, const flow_map_data& data, const flow_map_data& held_out);

// Checks of the force before learning: a wrong force would not be noticed otherwise.

/// check_force() at four states, from the middle of each quarter of the data. A system that is a
/// potential only has nothing to check. How far these and their finishes lie apart gives the lengths of
/// coordinates. Throws std::invalid_argument with its report. The data must be valid.
void require_sound_force(const model& system, const flow_map_data& data);

}  // namespace nysalt

// Data of a fit: what is known of them, coarser and redistributed ones, and the losses on them.

namespace nysalt::detail {

/// Whether the first trajectory, which rank 0 has, is the same. In a bath other noise makes another of the
/// same start.
bool begin_alike(const flow_map_data& a, const flow_map_data& b);

/// The root mean square error of the reference, where it was checked: against its finer self, along noisy
/// paths with error_over_difference.
double error_of_reference(const flow_map_data& data, const metric& measure);

/// The number of steps of the shortest trajectory.
int shortest_of(const flow_map_data& data);

/// The mean over windows and times of each squared residual of the distance from where a window begins.
Eigen::VectorXd motion_in(const flow_map_data& data, const metric& measure, const after_steps_options& how);

/// The stages of a search use only some of the trajectories, 16 at least, where all have more
/// coordinates together than are needed to find minima: a hundred trajectories of a dozen.
int trajectories_apart(const flow_map_data& data, Eigen::Index coordinates);

// Held-out data in longer steps: methods of different steps are compared at the times that they share.

/// Pairs over `times` steps each, of whole stretches from the beginning of each trajectory on. Without noise.
flow_map_data coarser(const flow_map_data& data, int times);

/// The multiples of `times` nearest to the times of a loss, in steps that are longer by that factor; without
/// steps if the trajectories, of `shortest` steps, have no multiple.
after_steps_options in_longer_steps(const after_steps_options& how, int times, int shortest);

/// Each rank gets the trajectories that it has in `next`, a share of more, from the rank that had them. Each
/// message is waited for in one order that all ranks keep, so that none waits for ever. Cost: a message for
/// each pair of ranks whose shares meet.
void redistribute(flow_map_data& data, const shard& next, Eigen::Index dimension);

// The parts of a problem of learning that depend on the loss and on its number of steps.

/// The held-out loss evaluated at every `times`-th step only; null if the trajectories are shorter.
using loss_by_times = std::function<std::shared_ptr<const data_loss>(int times)>;

/// From what the losses of a problem are made.
struct source_of_losses {
  const run_time_family& family;
  const model& system;
  const flow_map_data& data;
  const flow_map_data& held_out;
  loss_choice chosen;
  const other_loss* other;  // null: the chosen one is minimised
  coordinates which;
  std::shared_ptr<const metric> measure;  // in them
  int threads;
  bool in_lanes;
  std::shared_ptr<const flow_map_data> kept_held_out = {};  // null: rivals need none beyond the problem

  loss_inputs inputs(const flow_map_data& pairs, after_steps_options how) const {
    how.threads = threads;
    return {family, system, pairs, measure, std::move(how), in_lanes};
  }
  data_loss over(const flow_map_data& pairs, const after_steps_options& how) const {
    const auto from = inputs(pairs, how);
    if (other == nullptr) return chosen.kind->over_data(from);
    return in_lanes ? after_steps_of(from, *other->in_lanes) : after_steps_of(from, *other->one_by_one);
  }
  data_loss at_end() const {
    const int end = shortest_of(held_out);
    return of_states(inputs(held_out, {.steps = {end}, .apart = end}));
  }
  bool asks_data() const { return other != nullptr || chosen.kind->asks_data(); }
};

/// The loss over the kept held-out data by these times and by their multiples, made where it is first asked
/// for. Refers to nothing of `from`.
loss_by_times losses_by_times(const source_of_losses& from, const data_loss& held,
                              const after_steps_options& how);

/// Other methods at the cost of the family, by a loss of held-out data.
using rivals_by = std::function<std::optional<rival_method>(const tabulated&, const loss_by_times&)>;

/// Sets the members of `problem` that depend on the horizon of the loss, which is at most `most_steps` steps,
/// and `problem.shorter`, the same problem over a quarter of that horizon. `before` counts the evaluations of
/// other losses at this rank. Collective.
void put_losses(learning_problem& problem, const source_of_losses& from, const rivals_by& rival,
                const data_loss& at_end, int most_steps, const std::function<std::int64_t()>& before);

}  // namespace nysalt::detail
