// SPDX-License-Identifier: BSL-1.0
#include "sampled_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <span>
#include <type_traits>
#include <vector>

#include "all_ranks.hpp"
#include "interruption.hpp"
#include "nysalt/communicator.hpp"
#include "nysalt/distributed_run.hpp"
#include "nysalt/ensembles/given_states.hpp"
#include "nysalt/stepper.hpp"
#include "observables.hpp"
#include "refusal.hpp"
#include "shared_batch.hpp"
#include "shared_sites.hpp"

namespace nysalt::program {

namespace {

/// Number of trajectories that all ranks together hold in memory at a time, each of `numbers` doubles: 10^6
/// doubles in all, but at least one block of lanes for each of the `workers`, the threads of all ranks; a
/// whole number of blocks for each of these.
std::int64_t trajectories_at_a_time(std::int64_t numbers, int lanes, std::int64_t workers) {
  const std::int64_t blocks = 1'000'000 / numbers / lanes;
  return std::max<std::int64_t>(blocks / workers, 1) * workers * lanes;
}

/// Trajectories of the rank that has most, at least one.
std::int64_t all_trajectories_of_rank(std::int64_t count, const communicator& ranks) {
  return std::max<std::int64_t>((count - 1) / ranks.size() + 1, 1);
}

/// With as many trajectories side by side as P has lanes. Rank 0 takes, and its plan says where to begin.
template <class P>
double run_in_batches(const initial_value_problem& made, const initial_states& starts, const method& method,
                      const sampled_plan& plan, const record_taker& take, const counter& progress,
                      const communicator& ranks) {
  using states = phase_point<P, Eigen::Dynamic>;
  // Threads that find no trajectory of their own share the steps of the others, where the system allows it.
  const std::int64_t blocks =
      (all_trajectories_of_rank(plan.trajectories.count, ranks) - 1) / lanes_in<P> + 1;
  const auto together_at_work = static_cast<int>(std::min<std::int64_t>(blocks, plan.trajectories.threads));
  const model system = made.system.on_threads(plan.trajectories.threads / together_at_work);
  std::vector<nysalt::detail::over_scalars<nysalt::detail::of_state>> watched;
  for (const auto& name : plan.observables) watched.push_back(observable(made, name));
  const auto read = [&](const states& x, std::span<P> values) {
    for (std::size_t i = 0; i < watched.size(); ++i) values[i] = watched[i](x);
  };
  const trajectories_plan& all = plan.trajectories;
  const auto stepper = make_stepper(system, method, all.step, counter_noise(all.seed));
  using batch = ensemble_run<P, std::remove_const_t<decltype(stepper)>>;
  const std::int64_t samples = longest_segment(all.steps, plan.segment) / plan.every + 1;
  const std::int64_t numbers = samples * std::ssize(plan.observables) + 3 * size(system);
  const std::int64_t at_a_time = trajectories_at_a_time(numbers, lanes_in<P>, ranks.sum(all.threads));
  std::int64_t first = plan.from.first;
  std::int64_t under_way = std::ssize(plan.from.batch.diverged_at);
  double energy_error = plan.from.energy_error;
  broadcast(ranks, energy_error);
  broadcast(ranks, first);
  broadcast(ranks, under_way);
  bool is_prolonged = plan.left != nullptr;
  broadcast(ranks, is_prolonged);
  while (first < all.count) {
    const std::int64_t count = under_way > 0 ? under_way : std::min(at_a_time, all.count - first);
    const shared_batch shared(first, count, lanes_in<P>, ranks);
    const bool goes_on = under_way > 0 || is_prolonged;
    const saved_runs saved =
        goes_on ? shared.scatter(runs_at_first(plan, first, count, ranks)) : saved_runs();
    std::optional<batch> runs;  // a rank may have none
    collectively(ranks, [&] {
      if (shared.count() == 0) return;
      const execution in_threads{.threads = all.threads};
      if (goes_on) {
        runs.emplace(stepper, starts, all.seed, shared.first(), shared.count(), saved, in_threads);
      } else {
        runs.emplace(stepper, starts, all.seed, shared.first(), shared.count(), in_threads);
      }
    });
    for (std::int64_t step = saved.step, end; step < all.steps; step = end) {
      end = end_of_segment(step, all.steps, plan.segment);
      const std::int64_t before = step > 0 ? step : -1;
      std::vector<record> records(static_cast<std::size_t>(shared.count()));
      for (auto& one : records) one.first = (before + plan.every) / plan.every * plan.every;
      const auto keep = [&](std::int64_t m, std::int64_t, std::span<const double> values) {
        auto& of_one = records[static_cast<std::size_t>(m - shared.first())].values;
        of_one.insert(of_one.end(), values.begin(), values.end());
      };
      const auto report_progress = [&](std::int64_t done) {
        if (!progress) return;
        const double of_segment = static_cast<double>(done) / static_cast<double>(shared.count());
        const double steps = static_cast<double>(step) + of_segment * static_cast<double>(end - step);
        const double of_batch = static_cast<double>(count) * steps / static_cast<double>(all.steps);
        const double of_all = static_cast<double>(first) + of_batch;
        progress(static_cast<std::int64_t>(1000.0 * of_all / static_cast<double>(all.count)));
      };
      collectively(ranks, [&] {
        if (runs)
          runs->go_on(end, plan.every, watched.size(), read, keep,
                      {.threads = all.threads, .progress = report_progress});
      });
      for (std::size_t i = 0; i < records.size(); ++i) {
        const auto lost = runs->diverged_at(shared.first() + static_cast<std::int64_t>(i));
        if (lost && *lost > before) records[i].diverged_at = lost;
      }
      shared.deliver(records, take);
      if (!is_handed_over(plan, end)) continue;
      const run_progress at{first, shared.gather(runs ? runs->save() : saved_runs()), energy_error};
      report_segment(plan, at, end, ranks);
    }
    for (std::int64_t m = shared.first(); m < shared.first() + shared.count(); ++m) {
      if (!runs->diverged_at(m)) energy_error = std::max(energy_error, runs->energy_error(m));
    }
    energy_error = std::ranges::max(all_gather(ranks, energy_error));
    first += count;
    under_way = 0;
    if (plan.segment) report_reached(plan, {first, {}, energy_error}, ranks);
  }
  return energy_error;
}

double run_from(const initial_states& starts, const initial_value_problem& made, const method& method,
                const sampled_plan& plan, const record_taker& take, const counter& progress) {
  // Where some ranks would have no trajectory, all share the sites of each.
  if (plan.trajectories.count < all_ranks().size() &&
      nysalt::detail::can_be_distributed(made.system, method, all_ranks())) {
    return run_on_shared_sites(made, starts, method, plan, take, progress, all_ranks());
  }
  // Few trajectories would leave most lanes empty, and lanes of a large system would leave the cache.
  const bool fills_lanes = plan.trajectories.count >= pack<double>::lanes / 4 && size(made.system) <= 20'000;
  if (!fills_lanes || !made.system.facts().in_lanes) {
    return run_in_batches<double>(made, starts, method, plan, take, progress, all_ranks());
  } else {
    return run_in_batches<nysalt::detail::lanes>(made, starts, method, plan, take, progress, all_ranks());
  }
}

}  // namespace

saved_runs runs_at_first(const sampled_plan& plan, std::int64_t first, std::int64_t count,
                         const communicator& ranks) {
  saved_runs all;
  on_first(ranks, [&] {
    const bool is_under_way = first == plan.from.first && !plan.from.batch.diverged_at.empty();
    all = is_under_way ? plan.from.batch : plan.left(first, count);
  });
  return all;
}

bool is_handed_over(const sampled_plan& plan, std::int64_t end) {
  return plan.segment && (end < plan.trajectories.steps || end == last_check(end));
}

void report_segment(const sampled_plan& plan, const run_progress& at, std::int64_t end,
                    const communicator& ranks) {
  on_first(ranks, [&] {
    if (plan.ended && end == last_check(plan.trajectories.steps)) plan.ended(at.first, at.batch);
  });
  if (end < plan.trajectories.steps) report_reached(plan, at, ranks);
}

void report_reached(const sampled_plan& plan, const run_progress& at, const communicator& ranks) {
  const auto signal = -static_cast<int>(ranks.minimum(-noted_signal()));
  on_first(ranks, [&] {
    if (plan.reached) plan.reached(at, signal != 0);
  });
  if (signal != 0) throw interrupted(signal);
}

double run(const prepared_problem& system, const method& method, const sampled_plan& plan,
           const record_taker& take, const counter& progress) {
  return run_from(system.prepared_starts(), system.definition(), method, plan, take, progress);
}

void integrate(const prepared_problem& system, const method& method, const trajectories_plan& plan,
               std::span<double> q, std::span<double> p, const counter& progress) {
  const auto n = static_cast<std::size_t>(system.dimension());
  const auto count = static_cast<std::size_t>(plan.count);
  std::vector<phase_point<double, Eigen::Dynamic>> states;
  for (std::size_t m = 0; m < count; ++m) {
    const auto part = [&](std::span<double> of) {
      return Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(of.data() + m * n, system.dimension()));
    };
    states.push_back({part(q), part(p)});
    if (!is_finite(states.back())) {
      refuse("the state of trajectory {} must be finite, got one where {}", m,
             nysalt::detail::not_finite_in(states.back()));
    }
  }
  sampled_plan sampled{.trajectories = plan, .observables = {}, .every = plan.steps};
  for (std::size_t i = 1; i <= n; ++i) sampled.observables.push_back(fmt::format("q{}", i));
  for (std::size_t i = 1; i <= n; ++i) sampled.observables.push_back(fmt::format("p{}", i));
  sampled.segment = short_segment(system.dimension());
  std::ranges::fill(q, std::numeric_limits<double>::quiet_NaN());
  std::ranges::fill(p, std::numeric_limits<double>::quiet_NaN());
  const auto take = [&](std::int64_t m, const record& segment) {
    const std::int64_t last = std::ssize(segment.values) / (2 * system.dimension()) - 1;  // of its samples
    if (segment.first + last * plan.steps < plan.steps) return;
    const auto state = std::span(segment.values).last(2 * n);
    std::ranges::copy(state.first(n), q.begin() + m * system.dimension());
    std::ranges::copy(state.last(n), p.begin() + m * system.dimension());
  };
  run_from(nysalt::listed<Eigen::Dynamic>(std::move(states)), system.definition(), method, sampled, take,
           progress);
}

}  // namespace nysalt::program
