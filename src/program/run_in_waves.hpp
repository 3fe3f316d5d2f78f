// SPDX-License-Identifier: BSL-1.0
// Sampled trajectories, as many at a time as fit into memory.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <type_traits>
#include <vector>

#include "bundled_system.hpp"
#include "nysalt/detail/together.hpp"
#include "nysalt/ensemble_run.hpp"
#include "nysalt/stepper.hpp"
#include "observables.hpp"
#include "shared_wave.hpp"
#include "stretches.hpp"

namespace nysalt::program {

/// How many trajectories, of so many numbers each, are in the memory of all ranks at a time: a million
/// numbers, or where trajectories are long, a block for each thread of a rank. With more ranks a rank has
/// fewer, and each of its threads equally many.
inline std::int64_t trajectories_at_a_time(std::int64_t numbers, int lanes, std::int64_t workers) {
  const std::int64_t blocks = 1'000'000 / numbers / lanes;
  return std::max<std::int64_t>(blocks / workers, 1) * workers * lanes;
}

/// bundled_system::run, with as many trajectories side by side as P has lanes. Rank 0 takes, and its plan
/// says where to begin; all ranks call the function.
template <class P>
void run_in_waves(const made_system& made, const initial_states& starts, const tabulated& method,
                  const sampled_plan& plan, const std::function<void(std::int64_t, const record&)>& take,
                  const counter& progress, const communicator& ranks) {
  using states = phase_point<P, Eigen::Dynamic>;
  const model& system = made.system;
  std::vector<nysalt::detail::over_scalars<nysalt::detail::of_state>> watched;
  for (const auto& name : plan.observables) watched.push_back(observable(made, name));
  const auto read = [&](const states& x, std::span<P> values) {
    for (std::size_t i = 0; i < watched.size(); ++i) values[i] = watched[i](x);
  };
  const trajectories_plan& all = plan.trajectories;
  const auto stepper = make_stepper(system, method, all.step, counter_noise(all.seed));
  using wave = ensemble_run<P, std::remove_const_t<decltype(stepper)>>;
  const stretches run_stretches(all.steps, plan.stretch);
  const std::int64_t numbers =
      (run_stretches.longest() / plan.every + 1) * std::ssize(plan.observables) + 3 * size(system);
  const std::int64_t at_a_time = trajectories_at_a_time(numbers, lanes_in<P>, ranks.total(all.threads));
  std::int64_t first = plan.from.first;
  std::int64_t under_way = std::ssize(plan.from.wave.diverged_at);
  broadcast(ranks, first);
  broadcast(ranks, under_way);
  while (first < all.count) {
    const std::int64_t count = under_way > 0 ? under_way : std::min(at_a_time, all.count - first);
    const shared_wave shared(first, count, lanes_in<P>, ranks);
    const saved_runs saved = under_way > 0 ? shared.scatter(plan.from.wave) : saved_runs();
    std::optional<wave> runs;  // a rank may have none
    together(ranks, [&] {
      if (shared.count() == 0) return;
      if (under_way > 0) {
        runs.emplace(stepper, starts, all.seed, shared.first(), shared.count(), saved, all.threads);
      } else {
        runs.emplace(stepper, starts, all.seed, shared.first(), shared.count(), all.threads);
      }
    });
    for (std::int64_t step = saved.step, end; step < all.steps; step = end) {
      end = run_stretches.end_after(step);
      const std::int64_t before = under_way > 0 || step > 0 ? step : -1;
      std::vector<record> records(static_cast<std::size_t>(shared.count()));
      for (auto& one : records) one.first = (before + plan.every) / plan.every * plan.every;
      const auto keep = [&](std::int64_t m, std::int64_t, std::span<const double> values) {
        auto& of_one = records[static_cast<std::size_t>(m - shared.first())].values;
        of_one.insert(of_one.end(), values.begin(), values.end());
      };
      const auto tell = [&](std::int64_t done) {
        if (!progress) return;
        const double of_stretch = static_cast<double>(done) / static_cast<double>(shared.count());
        const double steps = static_cast<double>(step) + of_stretch * static_cast<double>(end - step);
        const double of_wave = static_cast<double>(count) * steps / static_cast<double>(all.steps);
        const double of_all = static_cast<double>(first) + of_wave;
        progress(static_cast<std::int64_t>(1000.0 * of_all / static_cast<double>(all.count)));
      };
      together(ranks, [&] {
        if (runs) runs->go_on(end, plan.every, watched.size(), read, keep, all.threads, tell);
      });
      for (std::size_t i = 0; i < records.size(); ++i) {
        const auto lost = runs->diverged_at(shared.first() + static_cast<std::int64_t>(i));
        if (lost && *lost > before) records[i].diverged_at = lost;
      }
      shared.hand_over(records, take);
      if (!plan.stretch || end == all.steps) continue;
      const standing at{first, shared.gather(runs ? runs->save() : saved_runs())};
      on_first(ranks, [&] { plan.reached(at); });
    }
    first += count;
    under_way = 0;
    if (plan.stretch) on_first(ranks, [&] { plan.reached({first, {}}); });
  }
}

}  // namespace nysalt::program
