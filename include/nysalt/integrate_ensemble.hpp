// SPDX-License-Identifier: BSL-1.0
// Many trajectories from start to finish, in lanes and on threads, each watched over.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <stdexcept>
#include <vector>

#include "nysalt/communicator.hpp"
#include "nysalt/detail/ensemble_loop.hpp"
#include "nysalt/detail/lockstep.hpp"
#include "nysalt/detail/sentence.hpp"
#include "nysalt/ensemble.hpp"
#include "nysalt/method.hpp"
#include "nysalt/shard.hpp"

namespace nysalt {

/// Number, length, seed and threads of the trajectories of an ensemble.
struct ensemble_options {
  std::int64_t trajectories = 100;  ///< number of trajectories
  std::int64_t steps = 1000;        ///< steps of each trajectory
  std::int64_t every = 1;           ///< steps between observations
  std::uint64_t seed = 1;           ///< seed of the starts
  int threads = 1;                  ///< changes no bit
  std::int64_t first = 0;           ///< number of the first trajectory
  std::function<void(std::int64_t done)> progress =
      {};                                 ///< progress callback, after each block; calls do not overlap
  const communicator* ranks = &one_rank;  ///< ranks that share the trajectories; changes no bit
};

namespace detail {

/// The trajectories of this rank: consecutive ones.
struct own_trajectories {
  std::int64_t first;  ///< place of the first in the ensemble
  std::int64_t count;  ///< how many
};

/// f(stepper), of a black box with a stepper of a copy of its own.
template <class Stepper>
void with_own_system(const Stepper& stepper, const auto& f) {
  if constexpr (ErasedSystem<typename Stepper::system_type>) {
    if (is_black_box(stepper.system())) {
      const auto own = stepper.system().separate();
      return f(stepper.with_system(own));
    }
  }
  f(stepper);
}

/// The driver of ensembles: follows the trajectories of this rank, as many at a time as T has lanes, on
/// several threads. Of trajectories place .. place + count - 1 of the ensemble, counted from options.first
/// on, visitor_of(place, count) makes a visitor: take(n, numbers, live) is called with what read(x, numbers)
/// wrote of the states at step n, in the order of time, and end(run) with the lockstep that is at its end. A
/// thread runs `of_thread` trajectories at a time, one block after the other. Collective.
template <class T, class Stepper, Ensemble<typename Stepper::system_type> E, class Read, class VisitorOf>
void follow_ensemble(const Stepper& stepper, const E& ensemble, const ensemble_options& options,
                     const own_trajectories& own, int of_thread, std::size_t width, const Read& read,
                     const VisitorOf& visitor_of) {
  const auto follow_block = [&](std::int64_t place, int count) {
    const std::int64_t first = options.first + place;
    const auto start = sound_starts<T>(stepper.system(), ensemble, options.seed, first, count);
    auto visitor = visitor_of(place, count);
    const auto take = [&](std::int64_t n, std::span<const T> seen, const condition_of<T>& live) {
      visitor.take(n, seen, live);
    };
    observe_starts(start, count, width, read, take);
    with_own_system(stepper, [&](const Stepper& own) {
      lockstep<Stepper, T> run(own, start, count, first);
      run.go_on(options.steps, options.every, width, read, take);
      visitor.end(run);
    });
  };
  const auto follow = [&](std::int64_t place, int count) {
    for (int done = 0; done < count; done += lanes_in<T>) {
      follow_block(own.first + place + done, std::min(lanes_in<T>, count - done));
    }
  };
  collectively(*options.ranks, [&] {
    for_each_block(own.count, of_thread, options.threads, follow,
                   progress_of_share(*options.ranks, own.count, options.trajectories, options.progress));
  });
}

}  // namespace detail

/// Follows trajectories m = first .. first + trajectories - 1 from ensemble(seed, m), as many at a time as T
/// has lanes. At steps n = 0, every, 2 every, ... read(x, numbers) writes `width` numbers of the states over
/// T to a span, and take(m, n, numbers) is given those of one trajectory, in doubles: in the order of time
/// for each m, from several threads for different m. Nothing of a trajectory's divergence or beyond is taken;
/// it may be read, so reading must bear any state. Neither lanes nor threads change a bit; sums over
/// m are then taken by tree_sum. Of several ranks each follows, and takes of, those of its
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
  constexpr std::int64_t most = std::int64_t{1} << 48U;  // the number of trajectories with noise of their own
  if (options.trajectories < 1 || options.trajectories > most || options.first < 0 ||
      options.first > most - options.trajectories || options.steps < 0 || options.every < 1) {
    throw std::invalid_argument(sentence(
        "integrate_ensemble: trajectories must be >= 1, first and steps >= 0, every >= 1, and first + "
        "trajectories <= 2^48, got trajectories {}, first {}, steps {} and every {}",
        options.trajectories, options.first, options.steps, options.every));
  }
  const communicator& ranks = *options.ranks;
  const shard own(options.trajectories, ranks);
  std::vector<std::optional<std::int64_t>> diverged_at(static_cast<std::size_t>(options.trajectories));
  struct visitor {
    std::vector<std::optional<std::int64_t>>& diverged_at;
    std::int64_t place;
    int count;
    detail::take_in_order<Take> take;

    void end(const lockstep<Stepper, T>& run) {
      for (int k = 0; k < count; ++k) diverged_at[static_cast<std::size_t>(place + k)] = run.diverged_at(k);
    }
  };
  const auto visitor_of = [&](std::int64_t place, int count) {
    return visitor{diverged_at, place, count, {take, options.first + place, count, width}};
  };
  detail::follow_ensemble<T>(stepper, ensemble, options, {own.first(), own.count()}, lanes_in<T>, width, read,
                             visitor_of);
  own.gather(diverged_at);
  return diverged_at;
}

/// Integrates an ensemble with one observable: take(m, n, observable(x)). The observable is called for one
/// trajectory after the other, or for all lanes at a time if it is marked by over_lanes; of trajectories that
/// have diverged too, so it must bear any state.
template <System S, Ensemble<S> E, class Observable, class Take>
std::vector<std::optional<std::int64_t>> integrate_ensemble(const S& system, const tabulated& method, double step,
                                                            const E& ensemble,
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
