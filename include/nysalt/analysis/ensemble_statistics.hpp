// SPDX-License-Identifier: BSL-1.0
// Statistics of an ensemble of trajectories, none of which is kept.
#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "nysalt/analysis/gathered_statistics.hpp"
#include "nysalt/integrate_ensemble.hpp"

namespace nysalt {

/// Samples of a trajectory: the steps from..steps that `every` divides. Throws std::invalid_argument if the
/// options are out of range, or lags need more samples.
std::int64_t samples_of_trajectory(const ensemble_options& options, const statistics_wanted& wanted);

namespace detail {
/// As many trajectories at a time as T has lanes.
template <class T, class Stepper>
gathered_statistics statistics_in_lanes(const Stepper& stepper, const auto& ensemble,
                                        const ensemble_options& options, const auto& observable,
                                        const statistics_wanted& wanted) {
  using state = phase_point<T, Stepper::dimension>;
  const std::int64_t samples = samples_of_trajectory(options, wanted);
  const auto starts = [&](std::int64_t first, int count) {
    return sound_starts<T>(stepper.system(), ensemble, options.seed, first, count);
  };
  // Any number near the mean, the same for all.
  const double seen_first = lane(value_in_lanes<T>(observable, starts(options.first, 1)), 0);
  const double centre = std::isfinite(seen_first) ? seen_first : 0.0;
  const double interval = static_cast<double>(options.every) * stepper.step_size();
  const communicator& ranks = *options.ranks;
  gathering all(wanted, options.trajectories, samples, interval, centre, ranks);

  const auto read = [&](const state& x, std::span<T> numbers) {
    read_sample(wanted, stepper, observable, x, numbers);
  };
  struct visitor {
    gathering& all;
    statistics_along<T> along;
    std::int64_t place;
    int count;

    void take(std::int64_t n, std::span<const T> seen, const condition_of<T>& live) {
      along.add(n, seen, live);
    }
    void end(const lockstep<Stepper, T>& run) {
      for (int k = 0; k < count; ++k) {
        const auto lost_at = along.lost_at(k);
        all.keep(place + k, along, k, lost_at ? lost_at : run.diverged_at(k));
      }
    }
  };
  const auto visitor_of = [&](std::int64_t place, int count) {
    return visitor{all, statistics_along<T>(wanted, centre), place, count};
  };
  detail::follow_ensemble<T>(stepper, ensemble, options, {all.first(), all.count()},
                             all.trajectories_of_thread(), numbers_of_sample(wanted), read, visitor_of);
  all.gather();
  return all.result(options.first);
}
}  // namespace detail

/// Follows trajectories m = first .. first + trajectories - 1 from ensemble(seed, m), as many at a time as
/// there are lanes, and gathers what is wanted of one observable at the steps n = 0, every, 2 every, ... from
/// wanted.from on. The observable is called as in integrate_ensemble: for all lanes at a time if it is marked
/// by over_lanes, which is much faster; it must bear any state.
///
/// A trajectory that diverges, or where a number is not finite, counts in nothing, not even with what came
/// before: runs that are short because they go astray would bend every distribution. It is reported in
/// `lost`. Neither lanes, threads nor ranks change a bit.
///
/// Ranks share whole groups of the jackknife, so that each sum over one keeps its order; there are 33 to 64,
/// and more ranks than these have nothing to do. All get the result.
///
/// Memory: 48 bytes a trajectory, a histogram (8 bytes a bin) for each of 64 groups, which the result keeps,
/// on each rank, and none that grows with the steps. Cost of a sample, beside the steps and the observable: a
/// product a lag, and an increment for the histogram. Throws std::invalid_argument if the options are out of
/// range, there are not more samples than lags, or a start does not fit.
template <class Stepper, Ensemble<typename Stepper::system_type> E, class Observable>
gathered_statistics ensemble_statistics(const Stepper& stepper, const E& ensemble,
                                        const ensemble_options& options, const Observable& observable,
                                        const statistics_wanted& wanted) {
  return detail::with_scalar_of(stepper.system(), [&]<class T>(T) {
    return detail::statistics_in_lanes<T>(stepper, ensemble, options, observable, wanted);
  });
}

}  // namespace nysalt
