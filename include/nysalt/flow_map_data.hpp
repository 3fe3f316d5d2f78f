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
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "nysalt/counted.hpp"
#include "nysalt/energy_range.hpp"
#include "nysalt/ensemble.hpp"
#include "nysalt/ensemble_loop.hpp"
#include "nysalt/reference.hpp"

namespace nysalt {

/// Pairs (start, finish) with finish one step later on the reference trajectory, trajectory by trajectory.
template <int N>
struct flow_map_data {
  std::vector<phase_point<double, N>> start;
  std::vector<phase_point<double, N>> finish;
  std::vector<std::size_t> first_of;  // trajectory m holds the pairs first_of[m] .. first_of[m + 1] - 1

  double step = 0.0;

  // In a bath: standard normal numbers of the noise over so many equal parts of the step. Those of pair n are
  // noise[n noise_parts + k], k = 0 .. noise_parts - 1.
  int noise_parts = 0;
  std::vector<vector<double, N>> noise;

  // A few finishes again with the finer reference: {pair, finish}. They tell the reference's own error.
  std::vector<std::pair<std::size_t, phase_point<double, N>>> finer;

  // Provenance.
  std::string system;
  std::string ensemble;
  std::string reference;
  std::uint64_t seed = 0;
  std::int64_t evaluations = 0;  // force evaluations that it took, checks included
  double seconds = 0.0;
  std::optional<energy_range> energies;  // of all starts and finishes; none where H is not known

  std::size_t pairs() const { return start.size(); }
  std::size_t trajectories() const { return first_of.empty() ? 0 : first_of.size() - 1; }
  /// The one that a pair belongs to, from 0.
  std::size_t trajectory_of(std::size_t pair) const {
    return static_cast<std::size_t>(std::upper_bound(first_of.begin(), first_of.end(), pair) -
                                    first_of.begin()) -
           1;
  }
};

struct data_options {
  double step;                      // the step to learn for
  double horizon = 0.5;             // length of each trajectory
  std::int64_t trajectories = 100;  // independent starts
  std::uint64_t seed = 1;
  std::int64_t first = 0;  // number of the first trajectory: which start and which noise it has
  int noise_parts = 0;     // of a step whose noise is kept: what the letters O to be learned with need
  int threads = 1;         // changes no bit of the data
  // Told after some trajectories how many are done; from any thread, never two calls at once.
  std::function<void(std::int64_t done)> progress{};
};

namespace detail {
[[noreturn]] inline void refuse_size(const char* what, std::size_t n, Eigen::Index its, Eigen::Index wanted) {
  throw std::invalid_argument(
      fmt::format("{} {} of the data has not the dimension of the system: {} for {}", what, n, its, wanted));
}
}  // namespace detail

/// Throws std::invalid_argument unless the data are of this system, hold pairs of its size, all finite, and
/// trajectories that cover them; for data that came from elsewhere. What is not finite is named: coordinate,
/// pair and trajectory, all but coordinates counted from 0.
template <System S>
void require_valid(const flow_map_data<S::dimension>& data, const S& system) {
  if (data.system != describe(system)) {
    throw std::invalid_argument(
        fmt::format("the data are of {}, the system is {}", data.system, describe(system)));
  }
  const bool covers = !data.first_of.empty() && data.first_of.front() == 0 &&
                      data.first_of.back() == data.pairs() &&
                      std::is_sorted(data.first_of.begin(), data.first_of.end());
  if (data.pairs() == 0 || data.finish.size() != data.pairs() || !covers) {
    throw std::invalid_argument(fmt::format("the data are not whole: {} starts, {} finishes, {} trajectories",
                                            data.pairs(), data.finish.size(), data.trajectories()));
  }
  if (data.noise_parts < 0 ||
      data.noise.size() != data.pairs() * static_cast<std::size_t>(data.noise_parts)) {
    throw std::invalid_argument(fmt::format("the data are not whole: {} pairs with noise in {} parts hold {}",
                                            data.pairs(), data.noise_parts, data.noise.size()));
  }
  if (data.step == 0.0 || !std::isfinite(data.step)) {
    throw std::invalid_argument(fmt::format("the data cannot have the step {}", data.step));
  }
  for (std::size_t n = 0; n < data.noise.size(); ++n) {
    const auto& its = data.noise[n];
    if (its.size() != size(system)) detail::refuse_size("noise", n, its.size(), size(system));
    for (Eigen::Index i = 0; i < its.size(); ++i) {
      if (std::isfinite(its[i])) continue;
      const std::size_t pair = n / static_cast<std::size_t>(data.noise_parts);
      throw std::invalid_argument(fmt::format(
          "the data hold what is not finite: coordinate {} of noise {} is {}, in pair {} of trajectory {}",
          i + 1, n, its[i], pair, data.trajectory_of(pair)));
    }
  }
  const auto require_sound = [&](const char* what, std::size_t pair, const auto& x) {
    if (x.q.size() != size(system)) detail::refuse_size(what, pair, x.q.size(), size(system));
    if (x.p.size() != size(system)) detail::refuse_size(what, pair, x.p.size(), size(system));
    if (is_finite(x)) return;
    throw std::invalid_argument(
        fmt::format("the data hold what is not finite: {} in the {} of pair {}, in trajectory {}",
                    detail::not_finite_in(x), what, pair, data.trajectory_of(pair)));
  };
  for (std::size_t n = 0; n < data.pairs(); ++n) {
    require_sound("start", n, data.start[n]);
    require_sound("finish", n, data.finish[n]);
  }
  for (const auto& [pair, finish] : data.finer) {
    if (pair >= data.pairs()) {
      throw std::invalid_argument(fmt::format(
          "the data are not whole: a finer finish is of pair {}, but there are {}", pair, data.pairs()));
    }
    require_sound("finer finish", pair, finish);
  }
}

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
  if (options.trajectories >
      static_cast<std::int64_t>(numbers_in_memory / numbers_in(options, steps, dimension))) {
    throw std::invalid_argument(fmt::format(
        "flow_map_data: {} trajectories of {} steps do not fit into memory; take fewer or a shorter horizon",
        options.trajectories, steps));
  }
  return static_cast<std::int64_t>(steps);
}

/// Writes the pairs and energies of trajectories first .. first + count - 1, one in each lane; returns the
/// force evaluations that they took.
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

/// finish = that of the finer reference from the same start, for every so many pairs.
template <SeparableSystem S, Reference<S> R>
std::int64_t check_reference(const S& system, const R& reference, const data_options& options,
                             flow_map_data<S::dimension>& data) {
  constexpr std::size_t checks = 16;  // enough for the size of an error
  const counted<S> watched(system);
  const R finer = reference.finer();
  std::size_t trajectory = 0;
  for (std::size_t pair = 0; pair < data.pairs(); pair += data.pairs() / checks + 1) {
    while (data.first_of[trajectory + 1] <= pair) ++trajectory;
    const path_place at{options.seed, static_cast<std::uint64_t>(options.first) + trajectory,
                        static_cast<std::int64_t>(pair - data.first_of[trajectory])};
    data.finer.emplace_back(pair, data.start[pair]);
    advance_lanes(watched, finer, data.finer.back().second, options.step, 1, at,
                  std::span<vector<double, S::dimension>>());
  }
  return watched.evaluations;
}

}  // namespace detail

/// As many as fit into memory. Throws std::invalid_argument if one does not, or has no step.
inline std::int64_t most_trajectories(data_options options, Eigen::Index dimension) {
  options.trajectories = 1;
  const auto steps = static_cast<double>(detail::steps_of_each(options, dimension));
  return static_cast<std::int64_t>(detail::numbers_in_memory / detail::numbers_in(options, steps, dimension));
}

/// Follows the reference from `trajectories` starts over floor(horizon/step) steps each, as many at a time as
/// there are lanes; in a bath along paths whose noise is kept in parts of a step. Threads share the ensemble
/// and the reference; each block of trajectories has its own copy of the system. Neither lanes nor threads
/// change a bit.
///
/// Throws std::invalid_argument if there is not one step, trajectory or thread, or if a start does not fit,
/// std::runtime_error if the reference diverges; of several trajectories that fail, the lowest is named.
/// Memory: two states a pair, and half a state for each part of noise. Cost: that of the reference, and one
/// energy a pair.
template <SeparableSystem S, Ensemble<S> E, Reference<S> R>
flow_map_data<S::dimension> make_flow_map_data(const S& system, const E& ensemble, const R& reference,
                                               const data_options& options) {
  const auto began = std::chrono::steady_clock::now();
  const std::int64_t steps = detail::steps_of_each(options, size(system));
  if (options.noise_parts > 0 && !PathReference<R, S>) {
    throw std::invalid_argument(fmt::format(
        "flow_map_data: the reference ({}) has no noise to keep; take fine_paths", reference.description()));
  }
  const auto total = static_cast<std::size_t>(options.trajectories * steps);

  flow_map_data<S::dimension> data;
  for (std::int64_t m = 0; m <= options.trajectories; ++m) {
    data.first_of.push_back(static_cast<std::size_t>(m * steps));
  }
  data.start.resize(total);
  data.finish.resize(total);
  data.noise_parts = options.noise_parts;
  data.noise.resize(total * static_cast<std::size_t>(options.noise_parts));
  std::vector<energy_range> energies(data.trajectories());
  std::atomic<std::int64_t> evaluations = 0;

  const auto follow = [&](std::int64_t first, int count) {
    evaluations +=
        detail::follow_reference(system, ensemble, reference, options, first, count, data, energies);
  };
  for_each_block(options.trajectories, lanes_of<S>, options.threads, follow, options.progress);

  evaluations += detail::check_reference(system, reference, options, data);

  if constexpr (HasEnergy<S>) {
    data.energies.emplace();
    for (const auto& seen : energies) {
      data.energies->include(seen.low);
      data.energies->include(seen.high);
    }
  }
  data.step = options.step;
  data.system = describe(system);
  data.ensemble = ensemble.description();
  data.reference = reference.description();
  data.seed = options.seed;
  data.evaluations = evaluations;
  data.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  return data;
}

}  // namespace nysalt
