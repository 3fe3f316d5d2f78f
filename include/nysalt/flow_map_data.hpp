// SPDX-License-Identifier: BSL-1.0
// The flow map at one step, in pairs of states: what is learned from.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "nysalt/energy.hpp"
#include "nysalt/execution.hpp"
#include "nysalt/initial_states.hpp"
#include "nysalt/model.hpp"
#include "nysalt/phase_point.hpp"
#include "nysalt/reference.hpp"
#include "nysalt/shard.hpp"

namespace nysalt {

namespace detail {

/// Position of the pairs of one rank among the pairs of all ranks.
struct shared_pairs {
  shard trajectories;  ///< distribution of the trajectories over ranks
  std::size_t first;   ///< number of the first pair at this rank, among all
  std::size_t total;   ///< pairs of all ranks
};

}  // namespace detail

/// Pairs (start, finish) with finish one step later on the reference trajectory, trajectory by trajectory. If
/// ranks share them, each has the pairs of its trajectories.
struct flow_map_data {
  phase_points start;                 ///< (q, p) where a step begins
  phase_points finish;                ///< (q, p) a step later
  std::vector<std::size_t> first_of;  ///< trajectory m holds the pairs first_of[m] .. first_of[m + 1] - 1

  double step = 0.0;  ///< h, of all pairs

  /// Number of equal parts of a step for which noise is kept, in a bath; 0: none.
  int noise_parts = 0;
  /// Standard normal numbers of that noise: the numbers of pair n are noise[n noise_parts + k] for k from 0
  /// to noise_parts - 1.
  detail::vector_list noise;

  /// Further states of the ensemble, beyond those that trajectories begin at, the most energetic of many
  /// among them: at all ranks the same. They are where frequencies are estimated.
  phase_points further_starts;
  /// Starts to judge methods on, see starts_to_judge(): at all ranks the same.
  phase_points judged_starts;

  /// A few finishes again with the finer reference: {pair, finish}. They estimate the reference's own error.
  std::vector<std::pair<std::size_t, phase_point<double, Eigen::Dynamic>>> finer;

  std::optional<detail::shared_pairs> shared;  ///< null if this rank has all pairs

  // Provenance of the data of all ranks.
  std::string system;                    ///< description of the system
  std::string ensemble;                  ///< description of the ensemble
  std::string reference;                 ///< description of the reference
  std::uint64_t seed = 0;                ///< seed of starts and noise
  std::int64_t evaluations = 0;          ///< force evaluations of the data on all ranks, checks included
  double seconds = 0.0;                  ///< wall time at this rank
  std::optional<energy_range> energies;  ///< energies of all starts and finishes; none where H is not known

  std::size_t pairs() const { return start.size(); }  ///< number of pairs at this rank
  /// Number of trajectories at this rank.
  std::size_t trajectories() const { return first_of.empty() ? 0 : first_of.size() - 1; }
  /// Number, from 0, of the trajectory at this rank that holds a pair.
  std::size_t trajectory_of(std::size_t pair) const;

  /// Distribution of the trajectories over ranks.
  shard share() const {
    return shared ? shared->trajectories : shard(static_cast<std::int64_t>(trajectories()));
  }
  /// Number of pairs of all ranks.
  std::size_t all_pairs() const { return shared ? shared->total : pairs(); }
  /// Number of the first pair at this rank, among the pairs of all ranks.
  std::size_t first_pair() const { return shared ? shared->first : 0; }
};

/// Number, length and seed of the trajectories of the data.
struct data_options {
  double step;                      ///< h, the step to learn for
  double horizon = 0.5;             ///< length of each trajectory, a time: floor(horizon/step) steps
  std::int64_t trajectories = 100;  ///< number of independent starts
  std::uint64_t seed = 1;           ///< seed of starts and noise
  std::int64_t first = 0;           ///< number of the first trajectory: which start and which noise it has
  int noise_parts = 0;              ///< equal parts of a step in which noise is kept, for letters O
  nysalt::execution execution{};    ///< threads, ranks and progress
};

namespace detail {

/// floor(horizon/step), if that and the number of trajectories can be.
std::int64_t steps_of_each(const data_options& options, Eigen::Index dimension);

/// Numbers of some pairs of all, rising: one somewhere in each of as many equal parts. Where is drawn, so
/// that no length of trajectories makes all of them starts, say.
std::vector<std::size_t> spread_pairs(std::size_t all, std::size_t most);

/// Largest number of trajectories: as many as fit into the memory of one rank, so that it does not
/// depend on the number of ranks. Throws std::invalid_argument if one does not, or has no step.
std::int64_t most_trajectories(data_options options, Eigen::Index dimension);

}  // namespace detail

/// Follows the reference from `trajectories` starts over floor(horizon/step) steps each, as many at a time as
/// there are lanes; in a bath along paths whose noise is kept in parts of a step. Threads share the ensemble
/// and the reference; each block of trajectories has its own copy of the system. Ranks share the
/// trajectories, and each keeps its own. Neither lanes nor threads nor ranks change a bit.
///
/// Throws std::invalid_argument if there is not one step, trajectory or thread, or if a start does not fit,
/// std::runtime_error if the reference diverges; of several trajectories that fail, the lowest is named.
/// Memory of a rank: two states a pair of its own, and half a state for each part of noise. Cost: the
/// reference, and one energy a pair.
flow_map_data make_flow_map_data(const model& system, const initial_states& ensemble,
                                 const reference& reference, const data_options& options);

namespace detail {

/// Makes of data with fewer trajectories, or none, the data of the options, which were the same but for their
/// number: only what is new is made. The pairs have the bits of those made at once; of finer finishes there
/// are more. Ranks hand over trajectories that become another's. Throws what make_flow_map_data does. Cost:
/// the trajectories that are new.
void extend_data(const model& system, const initial_states& ensemble, const reference& reference,
                 const data_options& options, flow_map_data& data);

}  // namespace detail

}  // namespace nysalt
