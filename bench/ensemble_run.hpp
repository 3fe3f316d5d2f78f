// SPDX-License-Identifier: BSL-1.0
// A run as a user has it: trajectories in memory, and the ensemble loop.
#pragma once

#include <cstdint>
#include <type_traits>
#include <vector>

#include "nysalt/ensembles/distributions.hpp"
#include "nysalt/families/nystrom.hpp"
#include "nysalt/family.hpp"
#include "nysalt/lanes.hpp"
#include "nysalt/method.hpp"
#include "nysalt/parallel/ensemble_loop.hpp"

namespace nysalt::bench {

using states = std::vector<phase_point<double, 6>>;

inline states starts_of(std::int64_t trajectories) {
  const fpu_chain<3> chain(50.0);
  const fpu_law<3> law(chain);
  states result;
  for (std::int64_t m = 0; m < trajectories; ++m) result.push_back(law(1, static_cast<std::uint64_t>(m)));
  return result;
}

void run_ensemble(states& all, const auto& stepper, std::int64_t steps, int threads) {
  const auto block = [&](std::int64_t first, int count) {
    constexpr int N = std::remove_cvref_t<decltype(stepper)>::dimension;
    const auto at = [&](int k) -> auto& { return all[static_cast<std::size_t>(first + k)]; };
    const auto start = [&](int k) { return phase_point<double, N>{at(k).q, at(k).p}; };
    auto run = stepper.open(detail::gather<pack<double>, N>(count, start), static_cast<std::uint64_t>(first));
    stepper.advance(run, steps);
    const auto end = stepper.synchronous(run);
    for (int k = 0; k < count; ++k) {
      const auto one = lane(end, k);
      at(k) = {one.q, one.p};
    }
  };
  detail::for_each_block(static_cast<std::int64_t>(all.size()), pack<double>::lanes, {.threads = threads},
                         block);
}

/// The two-stage step.
inline void run_ensemble(states& all, std::int64_t steps, int threads) {
  const fpu_chain<3> chain(50.0);
  run_ensemble(all, make_stepper(chain, member(nystrom(), {0.5, 0.4}), 0.01), steps, threads);
}

inline std::vector<double> numbers(const states& all) {
  std::vector<double> result;
  for (const auto& x : all) {
    result.insert(result.end(), x.q.begin(), x.q.end());
    result.insert(result.end(), x.p.begin(), x.p.end());
  }
  return result;
}

}  // namespace nysalt::bench
