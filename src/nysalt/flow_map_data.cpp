// SPDX-License-Identifier: BSL-1.0
#include "nysalt/flow_map_data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <random>
#include <stdexcept>

#include "learning/data_of_problem.hpp"
#include "nysalt/communicator.hpp"
#include "nysalt/core/steps_in.hpp"
#include "nysalt/ensembles/starts_to_judge.hpp"
#include "nysalt/noises/counter_noise.hpp"
#include "nysalt/parallel/ensemble_loop.hpp"

namespace nysalt {

std::size_t flow_map_data::trajectory_of(std::size_t pair) const {
  return static_cast<std::size_t>(std::upper_bound(first_of.begin(), first_of.end(), pair) -
                                  first_of.begin()) -
         1;
}

namespace detail {

namespace {

using state = phase_point<double, Eigen::Dynamic>;

constexpr double numbers_in_memory = 1e9;

/// Of one trajectory.
double numbers_of_trajectory(const data_options& options, double steps, Eigen::Index dimension) {
  return steps * (4.0 + options.noise_parts) * static_cast<double>(dimension);
}

/// What the trajectories of a rank are made from, and where they are written.
struct reference_pass {
  const initial_states& ensemble;
  const nysalt::reference& reference;
  const data_options& options;  ///< trajectories are numbered from options.first on
  flow_map_data& data;
  std::vector<energy_range>& energies;  ///< of each trajectory
};

/// Writes the pairs and energies of trajectories first .. first + count - 1, one in each lane; returns the
/// force evaluations that they took.
template <class T>
std::int64_t follow_reference(const reference_pass& pass, const model& system, std::int64_t first,
                              int count) {
  const data_options& options = pass.options;
  flow_map_data& data = pass.data;
  const auto place = [&](int k) { return static_cast<std::size_t>(first + k); };
  const auto include_energies = [&](const auto& x) {
    if (!has_energy(system)) return;
    const T found = energy<T>(system, x);
    for (int k = 0; k < count; ++k) pass.energies[place(k)].include(lane(found, k));
  };
  const auto store = [&](phase_points& all, std::size_t pair, const auto& x, int k) {
    const auto at = all[pair];
    auto q = at.q;
    auto p = at.p;
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      q[i] = lane(x.q[i], k);
      p[i] = lane(x.p[i], k);
    }
  };
  const std::int64_t number = options.first + first;
  const auto start = sound_starts<T>(system, pass.ensemble, options.seed, number, count);
  include_energies(start);
  first_in_lanes<T> lost;  // the step at which a lane was not finite any more
  const std::size_t steps = data.first_of[place(0) + 1] - data.first_of[place(0)];
  const auto parts = static_cast<std::size_t>(options.noise_parts);
  const auto run = pass.reference.open(system, start,
                                       {.length = options.step,
                                        .count = count,
                                        .at = {options.seed, static_cast<std::uint64_t>(number), 0},
                                        .noise_parts = options.noise_parts});
  const auto& x = run->state();
  for (std::size_t n = 0; n < steps; ++n) {
    for (int k = 0; k < count; ++k) store(data.start, data.first_of[place(k)] + n, x, k);
    run->advance();
    for (int k = 0; k < count; ++k) {
      const std::size_t pair = data.first_of[place(k)] + n;
      store(data.finish, pair, x, k);
      for (std::size_t part = 0; part < parts; ++part) {
        auto xi = data.noise[pair * parts + part];
        for (Eigen::Index i = 0; i < xi.size(); ++i) xi[i] = lane(run->noise()[part][i], k);
      }
    }
    include_energies(x);
    lost.take(!is_finite(x), static_cast<std::int64_t>(n) + 1);
  }
  for (int k = 0; k < count; ++k) {
    if (!lost[k]) continue;
    const state last =
        std::as_const(data.finish)[data.first_of[place(k)] + static_cast<std::size_t>(*lost[k]) - 1];
    throw std::runtime_error(
        fmt::format("flow_map_data: trajectory {} of the reference ({}) must be finite, got one that "
                    "diverged at step {}: {}",
                    number + k, pass.reference.description(), *lost[k], not_finite_in(last)));
  }
  return run->evaluations();
}

/// finish = that of the finer reference from the same start, for a few of all pairs.
std::int64_t check_reference(const model& system, const reference& reference, const data_options& options,
                             flow_map_data& data) {
  constexpr std::size_t checks = 16;  // enough for the size of an error
  const auto finer = reference.finer();
  std::int64_t evaluations = 0;
  for (const std::size_t number : spread_pairs(data.all_pairs(), checks)) {
    if (number < data.first_pair() || number >= data.first_pair() + data.pairs()) continue;
    const std::size_t pair = number - data.first_pair();
    const std::size_t trajectory = data.trajectory_of(pair);
    const path_place at{options.seed, static_cast<std::uint64_t>(options.first) + trajectory,
                        static_cast<std::int64_t>(pair - data.first_of[trajectory])};
    state x = std::as_const(data.start)[pair];
    evaluations += finer.advance(system, x, options.step, at);
    data.finer.emplace_back(pair, std::move(x));
  }
  return evaluations;
}

shared_pairs shared_by(const shard& all, std::int64_t steps) {
  return {all, static_cast<std::size_t>(all.first() * steps), static_cast<std::size_t>(all.total() * steps)};
}

/// The pairs of the trajectories of this rank, which are numbered from options.first on. Collective.
flow_map_data make_some_pairs(const model& system, const initial_states& ensemble, const reference& reference,
                              data_options options, const shard& share) {
  const std::int64_t steps = steps_of_each(options, size(system));
  flow_map_data data;
  std::vector<energy_range> energies;
  data.shared = shared_by(share, steps);
  collectively(share.ranks(), [&] {
    for (std::int64_t m = 0; m <= share.count(); ++m) {
      data.first_of.push_back(static_cast<std::size_t>(m * steps));
    }
    data.start.resize(data.first_of.back(), size(system));
    data.finish.resize(data.first_of.back(), size(system));
    data.noise_parts = options.noise_parts;
    data.noise.resize(data.pairs() * static_cast<std::size_t>(options.noise_parts), size(system));
    energies.resize(data.trajectories());
  });
  std::atomic<std::int64_t> evaluations = 0;
  options.first += share.first();
  const reference_pass pass{ensemble, reference, options, data, energies};
  with_scalar_of(system, [&]<class T>(T) {
    const auto follow = [&](const model& own, std::int64_t place, int n) {
      evaluations += follow_reference<T>(pass, own, place - share.first(), n);
    };
    for_each_lane_block(system, share, lanes_in<T>, options.execution, follow);
  });
  collectively(share.ranks(), [&] { evaluations += check_reference(system, reference, options, data); });
  if (has_energy(system)) {
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
void add_up(flow_map_data& data) {
  const shard all = data.share();
  if (all.ranks().is_single()) return;
  data.evaluations = all.ranks().sum(data.evaluations);
  if (!data.energies) return;
  for (const energy_range& seen : all_gather(all.ranks(), *data.energies)) {
    if (seen.low > seen.high) continue;  // a rank without trajectories
    data.energies->include(seen.low);
    data.energies->include(seen.high);
  }
}

/// The pairs of further trajectories behind those that there are.
void append(flow_map_data& data, flow_map_data further) {
  if (data.first_of.empty()) {
    data = std::move(further);
    return;
  }
  const std::size_t pairs = data.pairs();
  data.start.append(further.start);
  data.finish.append(further.finish);
  data.noise.append(further.noise);
  for (std::size_t m = 1; m < further.first_of.size(); ++m) {
    data.first_of.push_back(pairs + further.first_of[m]);
  }
  for (const auto& [pair, finish] : further.finer) data.finer.emplace_back(pairs + pair, finish);
  if (data.energies && further.energies) {
    data.energies->include(further.energies->low);
    data.energies->include(further.energies->high);
  }
  data.evaluations += further.evaluations;
}

}  // namespace

std::int64_t steps_of_each(const data_options& options, Eigen::Index dimension) {
  if (!(options.step > 0.0) || !std::isfinite(options.step) || !std::isfinite(options.horizon)) {
    throw std::invalid_argument(
        fmt::format("flow_map_data: the step must be positive and the horizon finite, got {} and {}",
                    options.step, options.horizon));
  }
  const double steps = detail::steps_in(options.horizon, options.step);
  if (!(steps >= 1.0) || options.trajectories < 1 || options.first < 0) {
    throw std::invalid_argument(
        fmt::format("flow_map_data: trajectories must be at least 1, first at least 0 and the horizon at "
                    "least a step, got {} from number {} over {} with the step {}",
                    options.trajectories, options.first, options.horizon, options.step));
  }
  if (options.noise_parts < 0) {
    throw std::invalid_argument(
        fmt::format("flow_map_data: noise_parts must be >= 0, got {}", options.noise_parts));
  }
  if (options.trajectories / options.execution.ranks->size() >
      static_cast<std::int64_t>(numbers_in_memory / numbers_of_trajectory(options, steps, dimension))) {
    throw std::invalid_argument(
        fmt::format("flow_map_data: the data must fit into memory, got {} trajectories of {} steps; take "
                    "fewer or a shorter horizon",
                    options.trajectories, steps));
  }
  return static_cast<std::int64_t>(steps);
}

std::vector<std::size_t> spread_pairs(std::size_t all, std::size_t most) {
  std::mt19937_64 bits{1};
  std::vector<std::size_t> result;
  for (std::size_t k = 0; k < most; ++k) {
    const std::size_t from = all / most * k + all % most * k / most;
    const std::size_t to = all / most * (k + 1) + all % most * (k + 1) / most;
    const double share = uniform_by_bits(bits());
    if (from == to) continue;
    result.push_back(from + static_cast<std::size_t>(share * static_cast<double>(to - from)));
  }
  return result;
}

}  // namespace detail

flow_map_data make_flow_map_data(const model& system, const initial_states& ensemble,
                                 const reference& reference, const data_options& options) {
  detail::steps_of_each(options, size(system));
  flow_map_data data;
  detail::extend_data(system, ensemble, reference, options, data);
  return data;
}

void detail::extend_data(const model& system, const initial_states& ensemble, const reference& reference,
                         const data_options& options, flow_map_data& data) {
  const std::int64_t there = data.share().total();
  if (there >= options.trajectories) return;
  const auto began = std::chrono::steady_clock::now();
  const std::int64_t steps = detail::steps_of_each(options, size(system));
  if (options.noise_parts > 0 && !reference.gives_noise()) {
    throw std::invalid_argument(
        fmt::format("flow_map_data: the reference must have noise to keep, got {}; take fine_paths",
                    reference.description()));
  }
  const shard all(options.trajectories, *options.execution.ranks);
  if (there > 0) detail::redistribute(data, all, size(system));

  data_options of_further = options;
  of_further.first += there;
  of_further.trajectories -= there;
  flow_map_data further = detail::make_some_pairs(system, ensemble, reference, of_further, all.beyond(there));
  detail::add_up(further);
  detail::append(data, std::move(further));
  data.further_starts = detail::typical_and_energetic_starts(
      system, ensemble, options.seed, options.first + options.trajectories, options.trajectories);
  data.judged_starts = starts_to_judge(system, ensemble);
  data.shared.reset();
  if (!all.ranks().is_single()) data.shared = detail::shared_by(all, steps);
  data.step = options.step;
  data.system = describe(system);
  data.ensemble = ensemble.description();
  data.reference = reference.description();
  data.seed = options.seed;
  data.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
}

std::int64_t detail::most_trajectories(data_options options, Eigen::Index dimension) {
  options.trajectories = 1;
  const auto steps = static_cast<double>(detail::steps_of_each(options, dimension));
  return static_cast<std::int64_t>(detail::numbers_in_memory /
                                   detail::numbers_of_trajectory(options, steps, dimension));
}

}  // namespace nysalt
