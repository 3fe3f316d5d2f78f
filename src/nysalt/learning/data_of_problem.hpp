// SPDX-License-Identifier: BSL-1.0
// Data of a fit: whether they can be learned from, what is known of them, and coarser or redistributed ones.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "nysalt/flow_map_data.hpp"
#include "nysalt/losses/loss_choice.hpp"
#include "nysalt/losses/window_error.hpp"
#include "nysalt/model.hpp"
#include "nysalt/phase_point.hpp"
#include "nysalt/shard.hpp"

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

// What is known of data before a fit, and data that are coarser or of other ranks.

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

}  // namespace nysalt::detail
