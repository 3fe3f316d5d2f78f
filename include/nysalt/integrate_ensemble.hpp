// SPDX-License-Identifier: BSL-1.0
// Many trajectories from start to finish, in lanes and on threads, each watched over.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <stdexcept>
#include <vector>

#include "nysalt/core/sentence.hpp"
#include "nysalt/ensemble.hpp"
#include "nysalt/execution.hpp"
#include "nysalt/method.hpp"
#include "nysalt/parallel/ensemble_loop.hpp"
#include "nysalt/shard.hpp"
#include "nysalt/stepping/lockstep.hpp"

namespace nysalt {

/// Number, length and seed of the trajectories of an ensemble.
struct ensemble_options {
  std::int64_t trajectories = 100;  ///< number of trajectories
  std::int64_t steps = 1000;        ///< steps of each trajectory
  std::int64_t every = 1;           ///< steps between observations
  std::uint64_t seed = 1;           ///< seed of the starts
  nysalt::execution execution{};    ///< progress is called after each block
  std::int64_t first = 0;           ///< number of the first trajectory
};

namespace detail {

/// Throws std::invalid_argument, in the name of `who`, if the options are out of range.
inline void require_ensemble(const char* who, const ensemble_options& options) {
  require_trajectories(who, options.trajectories, options.first);
  if (options.steps >= 0 && options.every >= 1) return;
  throw std::invalid_argument(sentence("{}: steps must be >= 0 and every >= 1, got steps {} and every {}",
                                       who, options.steps, options.every));
}

/// Measures the trajectories of this rank, as many at a time as T has lanes, on several threads. Of
/// trajectories place .. place + count - 1 of the ensemble, counted from options.first on,
/// measure_of(place, count) makes a Measure, and end(run) of that is called with the lockstep at its end. A
/// thread runs `of_thread` trajectories at a time, one block after the other. Collective.
template <class T, class Stepper, Ensemble<typename Stepper::system_type> E>
void measure_ensemble(const Stepper& stepper, const E& ensemble, const ensemble_options& options,
                      const shard& share, int of_thread, const auto& measure_of) {
  const auto follow = [&](const own_stepper<Stepper>& own, std::int64_t place, int count) {
    for (int done = 0; done < count; done += lanes_in<T>) {
      const int here = std::min(lanes_in<T>, count - done);
      const std::int64_t first = options.first + place + done;
      const auto start = sound_starts<T>(stepper.system(), ensemble, options.seed, first, here);
      auto measure = measure_of(place + done, here);
      see_starts<T>(start, here, measure);
      lockstep<Stepper, T> run(*own, start, here, first);
      run.go_on(options.steps, options.every, measure);
      measure.end(run);
    }
  };
  for_each_lane_block(stepper, share, of_thread, options.execution, follow);
}

}  // namespace detail

/// Follows trajectories m = first .. first + trajectories - 1 from ensemble(seed, m), as many at a time as T
/// has lanes. At steps n = 0, every, 2 every, ... read(x, numbers) writes `width` numbers of the states over
/// T to a span, and take(m, n, numbers) is given the numbers of one trajectory, in doubles: in the order of
/// time for each m, from several threads for different m. Nothing of a trajectory's divergence or beyond is
/// taken; it may be read, so reading must bear any state. Neither lanes nor threads change a bit; sums over
/// m are then taken by tree_sum. Of several ranks each follows, and takes of, the trajectories of its
/// shard(trajectories).
///
/// Returns where each trajectory diverged, if it did, on all ranks; divergence is checked as in
/// integrate(). Memory: 16 bytes a trajectory, and none that grows with the steps. Throws
/// std::invalid_argument if trajectories, steps, every or threads are out of range, or a start does not fit.
template <class T, class Stepper, Ensemble<typename Stepper::system_type> E, class Read, class Take>
std::vector<std::optional<std::int64_t>> integrate_ensemble(const Stepper& stepper, const E& ensemble,
                                                            const ensemble_options& options,
                                                            std::size_t width, const Read& read,
                                                            const Take& take) {
  detail::require_ensemble("integrate_ensemble", options);
  const shard own(options.trajectories, *options.execution.ranks);
  std::vector<std::optional<std::int64_t>> diverged_at(static_cast<std::size_t>(options.trajectories));
  struct taken : detail::take_in_order<Read, Take> {
    std::optional<std::int64_t>* diverged_at;

    void end(const detail::lockstep<Stepper, T>& run) {
      for (int k = 0; k < this->count; ++k) diverged_at[k] = run.diverged_at(k);
    }
  };
  detail::measure_ensemble<T>(
      stepper, ensemble, options, own, lanes_in<T>, [&](std::int64_t place, int count) {
        return taken{{read, take, options.first + place, count, std::vector<double>(width)},
                     diverged_at.data() + place};
      });
  own.gather(diverged_at);
  return diverged_at;
}

/// Integrates an ensemble with one observable: take(m, n, observable(x)). The observable is called for one
/// trajectory after the other, or for all lanes at a time if it is marked by over_lanes; of trajectories that
/// have diverged too, so it must bear any state.
template <System S, Ensemble<S> E, class Observable, class Take>
std::vector<std::optional<std::int64_t>> integrate_ensemble(const S& system, const method& method,
                                                            double step, const E& ensemble,
                                                            const ensemble_options& options,
                                                            const Observable& observable, const Take& take) {
  const auto read = [&]<class T>(const phase_point<T, S::dimension>& x, std::span<T> number) {
    number[0] = value_in_lanes<T>(observable, x);
  };
  const auto take_one = [&](std::int64_t m, std::int64_t n, std::span<const double> number) {
    take(m, n, number[0]);
  };
  const auto stepper = make_stepper(system, method, step);
  return detail::with_scalar_of(system, [&]<class T>(T) {
    return integrate_ensemble<T>(stepper, ensemble, options, 1, read, take_one);
  });
}

}  // namespace nysalt
