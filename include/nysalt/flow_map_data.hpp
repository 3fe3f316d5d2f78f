// SPDX-License-Identifier: BSL-1.0
// The flow map at one step, in pairs of states: what is learned from.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "nysalt/counted.hpp"
#include "nysalt/energy_range.hpp"
#include "nysalt/ensemble.hpp"
#include "nysalt/ensemble_loop.hpp"
#include "nysalt/ensembles/typical_and_energetic.hpp"
#include "nysalt/progress_of_share.hpp"
#include "nysalt/reference.hpp"
#include "nysalt/shard.hpp"
#include "nysalt/together.hpp"

namespace nysalt {

/// Where the pairs of one rank are among those of all.
struct shared_pairs {
  shard trajectories;  ///< which trajectories are whose
  std::size_t first;   ///< number of the first pair at this rank, among all
  std::size_t total;   ///< pairs of all ranks
};

/// Pairs (start, finish) with finish one step later on the reference trajectory, trajectory by trajectory. If
/// ranks share them, each has those of its trajectories.
template <int N>
struct flow_map_data {
  std::vector<phase_point<double, N>> start;   ///< (q, p) where a step begins
  std::vector<phase_point<double, N>> finish;  ///< (q, p) a step later
  std::vector<std::size_t> first_of;  ///< trajectory m holds the pairs first_of[m] .. first_of[m + 1] - 1

  double step = 0.0;  ///< h, of all pairs

  /// In how many equal parts of a step noise is kept, for systems in a bath; 0: it is not.
  int noise_parts = 0;
  /// Standard normal numbers of that noise: those of pair n are noise[n noise_parts + k] for k from 0 to
  /// noise_parts - 1.
  std::vector<vector<double, N>> noise;

  /// Further states of the ensemble, beyond those that trajectories begin at, the most energetic of many
  /// among them: at all ranks the same. They are where trial runs begin, and where frequencies are looked
  /// for.
  std::vector<phase_point<double, N>> further_starts;

  /// A few finishes again with the finer reference: {pair, finish}. They tell the reference's own error.
  std::vector<std::pair<std::size_t, phase_point<double, N>>> finer;

  std::optional<shared_pairs> shared;  ///< nothing if these are all

  // Provenance, that of all ranks.
  std::string system;                    ///< description of the system
  std::string ensemble;                  ///< description of the ensemble
  std::string reference;                 ///< description of the reference
  std::uint64_t seed = 0;                ///< of starts and noise
  std::int64_t evaluations = 0;          ///< force evaluations of all ranks that it took, checks included
  double seconds = 0.0;                  ///< wall time at this rank
  std::optional<energy_range> energies;  ///< of all starts and finishes; none where H is not known

  std::size_t pairs() const { return start.size(); }  ///< number of pairs at this rank
  /// Number of trajectories at this rank.
  std::size_t trajectories() const { return first_of.empty() ? 0 : first_of.size() - 1; }
  /// Number, from 0, of the trajectory at this rank that holds a pair.
  std::size_t trajectory_of(std::size_t pair) const {
    return static_cast<std::size_t>(std::upper_bound(first_of.begin(), first_of.end(), pair) -
                                    first_of.begin()) -
           1;
  }

  /// Which of all trajectories this rank has.
  shard share() const {
    return shared ? shared->trajectories : shard(static_cast<std::int64_t>(trajectories()));
  }
  /// Number of pairs of all ranks.
  std::size_t all_pairs() const { return shared ? shared->total : pairs(); }
  /// Number of the first pair at this rank, among those of all ranks.
  std::size_t first_pair() const { return shared ? shared->first : 0; }
};

/// Which trajectories are followed, for how long, and by whom.
struct data_options {
  double step;                         ///< h, the step to learn for
  double horizon = 0.5;                ///< length of each trajectory, a time: floor(horizon/step) steps
  std::int64_t trajectories = 100;     ///< number of independent starts
  std::uint64_t seed = 1;              ///< of starts and noise
  std::int64_t first = 0;              ///< number of the first trajectory: which start and which noise it has
  int noise_parts = 0;                 ///< equal parts of a step in which noise is kept, for letters O
  int threads = 1;                     ///< changes no bit of the data
  const communicator* ranks = &alone;  ///< who share the trajectories; changes no bit either
  /// Told after some trajectories how many are done; from any thread, never two calls at once.
  std::function<void(std::int64_t done)> progress{};
};

namespace detail {

constexpr double numbers_in_memory = 1e9;

/// Of one trajectory.
inline double numbers_in(const data_options& options, double steps, Eigen::Index dimension) {
  return steps * (4.0 + options.noise_parts) * static_cast<double>(dimension);
}

/// floor(horizon/step), if that and the number of trajectories can be.
inline std::int64_t steps_of_each(const data_options& options, Eigen::Index dimension) {
  if (!(options.step > 0.0) || !std::isfinite(options.step) || !std::isfinite(options.horizon)) {
    throw std::invalid_argument(
        fmt::format("flow_map_data: the step must be positive and the horizon finite, got {} and {}",
                    options.step, options.horizon));
  }
  const double steps = std::floor(options.horizon / options.step + 1e-9);
  if (!(steps >= 1.0) || options.trajectories < 1 || options.first < 0) {
    throw std::invalid_argument(fmt::format(
        "flow_map_data: {} trajectories from number {} over {} hold no step of {}; at least one of each is "
        "needed",
        options.trajectories, options.first, options.horizon, options.step));
  }
  if (options.noise_parts < 0) {
    throw std::invalid_argument(
        fmt::format("flow_map_data: noise in {} parts of a step cannot be", options.noise_parts));
  }
  if (options.trajectories / options.ranks->size() >
      static_cast<std::int64_t>(numbers_in_memory / numbers_in(options, steps, dimension))) {
    throw std::invalid_argument(fmt::format(
        "flow_map_data: {} trajectories of {} steps do not fit into memory; take fewer or a shorter horizon",
        options.trajectories, steps));
  }
  return static_cast<std::int64_t>(steps);
}

/// Writes the pairs and energies of trajectories first .. first + count - 1, one in each lane, of those from
/// number options.first on; returns the force evaluations that they took.
template <SeparableSystem S, Ensemble<S> E, Reference<S> R>
std::int64_t follow_reference(const S& system, const E& ensemble, const R& reference,
                              const data_options& options, std::int64_t first, int count,
                              flow_map_data<S::dimension>& data, std::vector<energy_range>& energies) {
  using T = scalar_of_lanes<lanes_of<S>>;
  const counted<S> watched(system);
  const auto place = [&](int k) { return static_cast<std::size_t>(first + k); };
  const auto include_energies = [&](const auto& x) {
    if constexpr (HasEnergy<S>) {
      const T its = energy_in_lanes<T>(system, x);
      for (int k = 0; k < count; ++k) energies[place(k)].include(lane(its, k));
    }
  };
  const std::int64_t number = options.first + first;
  auto x = sound_starts<T>(system, ensemble, options.seed, number, count);
  include_energies(x);
  std::array<std::optional<std::size_t>, lanes_of<S>> lost;  // at which step a lane was not finite any more
  const std::size_t steps = data.first_of[place(0) + 1] - data.first_of[place(0)];
  const auto parts = static_cast<std::size_t>(options.noise_parts);
  std::vector<vector<T, S::dimension>> noise(parts, make_vector<T>(system));
  path_place at{options.seed, static_cast<std::uint64_t>(number), 0};
  for (std::size_t n = 0; n < steps; ++n, ++at.step) {
    for (int k = 0; k < count; ++k) data.start[data.first_of[place(k)] + n] = lane(x, k);
    advance_lanes(watched, reference, x, options.step, count, at, std::span(noise));
    for (int k = 0; k < count; ++k) {
      const std::size_t pair = data.first_of[place(k)] + n;
      data.finish[pair] = lane(x, k);
      for (std::size_t part = 0; part < parts; ++part) {
        data.noise[pair * parts + part] = lane(noise[part], k);
      }
    }
    include_energies(x);
    const auto sound = is_finite(x);
    for (int k = 0; k < count; ++k) {
      auto& its = lost[static_cast<std::size_t>(k)];
      if (!its && !lane(sound, k)) its = n + 1;
    }
  }
  for (int k = 0; k < count; ++k) {
    if (!lost[static_cast<std::size_t>(k)]) continue;
    const std::size_t step = *lost[static_cast<std::size_t>(k)];
    throw std::runtime_error(fmt::format(
        "flow_map_data: trajectory {} is not finite at step {} ({}): the reference ({}) diverged", number + k,
        step, not_finite_in(data.finish[data.first_of[place(k)] + step - 1]), reference.description()));
  }
  // Evaluated over packs, a force is one of each lane's trajectory.
  return watched.evaluations * (AdvancesLanes<R, S, T> || PathReference<R, S> ? count : 1);
}

/// Numbers of some pairs of all, rising: one somewhere in each of as many equal parts. Where is drawn, so
/// that no length of trajectories makes all of them starts, say.
inline std::vector<std::size_t> spread_pairs(std::size_t all, std::size_t most) {
  std::mt19937_64 bits{1};
  std::vector<std::size_t> result;
  for (std::size_t k = 0; k < most; ++k) {
    const std::size_t from = all / most * k + all % most * k / most;
    const std::size_t to = all / most * (k + 1) + all % most * (k + 1) / most;
    const double share = static_cast<double>(bits() >> 11U) * 0x1p-53;
    if (from == to) continue;
    result.push_back(from + static_cast<std::size_t>(share * static_cast<double>(to - from)));
  }
  return result;
}

/// finish = that of the finer reference from the same start, for a few of all pairs.
template <SeparableSystem S, Reference<S> R>
std::int64_t check_reference(const S& system, const R& reference, const data_options& options,
                             flow_map_data<S::dimension>& data) {
  constexpr std::size_t checks = 16;  // enough for the size of an error
  const counted<S> watched(system);
  const R finer = reference.finer();
  for (const std::size_t number : spread_pairs(data.all_pairs(), checks)) {
    if (number < data.first_pair() || number >= data.first_pair() + data.pairs()) continue;
    const std::size_t pair = number - data.first_pair();
    const std::size_t trajectory = data.trajectory_of(pair);
    const path_place at{options.seed, static_cast<std::uint64_t>(options.first) + trajectory,
                        static_cast<std::int64_t>(pair - data.first_of[trajectory])};
    data.finer.emplace_back(pair, data.start[pair]);
    advance_lanes(watched, finer, data.finer.back().second, options.step, 1, at,
                  std::span<vector<double, S::dimension>>());
  }
  return watched.evaluations;
}

/// Trajectories begin .. begin + count - 1 of those of the options.
template <SeparableSystem S, Ensemble<S> E, Reference<S> R>
flow_map_data<S::dimension> make_some_pairs(const S& system, const E& ensemble, const R& reference,
                                            data_options options, const shard& all, std::int64_t begin,
                                            std::int64_t count) {
  const std::int64_t steps = steps_of_each(options, size(system));
  const auto of_trajectories = [&](std::int64_t m) { return static_cast<std::size_t>(m * steps); };
  flow_map_data<S::dimension> data;
  data.shared = shared_pairs{all, of_trajectories(begin), of_trajectories(options.trajectories)};
  for (std::int64_t m = 0; m <= count; ++m) data.first_of.push_back(of_trajectories(m));
  data.start.resize(of_trajectories(count));
  data.finish.resize(of_trajectories(count));
  data.noise_parts = options.noise_parts;
  data.noise.resize(data.pairs() * static_cast<std::size_t>(options.noise_parts));
  std::vector<energy_range> energies(data.trajectories());
  std::atomic<std::int64_t> evaluations = 0;
  options.first += begin;
  const auto follow = [&](std::int64_t first, int n) {
    evaluations += follow_reference(system, ensemble, reference, options, first, n, data, energies);
  };
  for_each_block(count, lanes_of<S>, options.threads, follow,
                 progress_of_share(all.ranks(), count, options.trajectories, options.progress));
  evaluations += check_reference(system, reference, options, data);
  if constexpr (HasEnergy<S>) {
    data.energies.emplace();
    for (const auto& seen : energies) {
      data.energies->include(seen.low);
      data.energies->include(seen.high);
    }
  }
  data.evaluations = evaluations;
  return data;
}

/// What is counted and seen at one rank becomes that of all.
template <int N>
void add_up(flow_map_data<N>& data) {
  const shard all = data.share();
  if (all.ranks().is_alone()) return;
  data.evaluations = all.ranks().total(data.evaluations);
  if (!data.energies) return;
  for (const energy_range& seen : in_order_of_ranks(all.ranks(), *data.energies)) {
    if (seen.low > seen.high) continue;  // a rank without trajectories
    data.energies->include(seen.low);
    data.energies->include(seen.high);
  }
}

}  // namespace detail

/// As many trajectories as fit into the memory of one rank, so that their number does not depend on that of
/// ranks. Throws std::invalid_argument if one does not, or has no step.
inline std::int64_t most_trajectories(data_options options, Eigen::Index dimension) {
  options.trajectories = 1;
  const auto steps = static_cast<double>(detail::steps_of_each(options, dimension));
  return static_cast<std::int64_t>(detail::numbers_in_memory / detail::numbers_in(options, steps, dimension));
}

/// Follows the reference from `trajectories` starts over floor(horizon/step) steps each, as many at a time as
/// there are lanes; in a bath along paths whose noise is kept in parts of a step. Threads share the ensemble
/// and the reference; each block of trajectories has its own copy of the system. Ranks share the
/// trajectories, and each keeps its own. Neither lanes nor threads nor ranks change a bit.
///
/// Throws std::invalid_argument if there is not one step, trajectory or thread, or if a start does not fit,
/// std::runtime_error if the reference diverges; of several trajectories that fail, the lowest is named.
/// Memory of a rank: two states a pair of its own, and half a state for each part of noise. Cost: that of the
/// reference, and one energy a pair.
template <SeparableSystem S, Ensemble<S> E, Reference<S> R>
flow_map_data<S::dimension> make_flow_map_data(const S& system, const E& ensemble, const R& reference,
                                               const data_options& options) {
  const auto began = std::chrono::steady_clock::now();
  detail::steps_of_each(options, size(system));
  if (options.noise_parts > 0 && !PathReference<R, S>) {
    throw std::invalid_argument(fmt::format(
        "flow_map_data: the reference ({}) has no noise to keep; take fine_paths", reference.description()));
  }
  const shard all(options.trajectories, *options.ranks);
  flow_map_data<S::dimension> data;
  together(all.ranks(), [&] {
    data = detail::make_some_pairs(system, ensemble, reference, options, all, all.first(), all.count());
  });
  detail::add_up(data);
  data.further_starts = typical_and_energetic_starts(
      system, ensemble, options.seed, options.first + options.trajectories, options.trajectories);
  if (options.ranks->is_alone()) data.shared.reset();
  data.step = options.step;
  data.system = describe(system);
  data.ensemble = ensemble.description();
  data.reference = reference.description();
  data.seed = options.seed;
  data.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  return data;
}

}  // namespace nysalt
