// SPDX-License-Identifier: BSL-1.0
// Statistics of an ensemble of trajectories, none of which is kept: temperatures, histograms,
// autocovariances.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "nysalt/analysis/statistics.hpp"
#include "nysalt/communicator.hpp"
#include "nysalt/divergence.hpp"
#include "nysalt/energy.hpp"
#include "nysalt/integrate_ensemble.hpp"

namespace nysalt {

/// sum_i p_i dK/dp_i / N, which is sum_i p_i^2/m_i / N for K = p M^-1 p / 2: its mean in the Gibbs ensemble
/// is kT, by equipartition. In units of energy. T is double or a pack.
template <class T, SystemOver<T> S>
T kinetic_temperature(const S& system, const phase_point<T, S::dimension>& x) {
  auto v = detail::make_vector<T>(system);
  velocity<T>(system, x.p, v);
  T sum(0.0);
  for (Eigen::Index i = 0; i < x.size(); ++i) sum += x.p[i] * v[i];
  return sum / static_cast<double>(x.size());
}

/// Kinetic temperature of the momenta p + (h/2) force(q) between two steps. For words that begin and end with
/// half a kick (Verlet, BAOAB) its mean is kT on a harmonic oscillator, where the kinetic temperature of the
/// momenta at the steps is low by z^2/4, z = omega h; of words that begin with a drift it knows nothing.
/// Cost: one force.
template <class T, SystemOver<T> S>
T half_step_kinetic_temperature(const S& system, double step, const phase_point<T, S::dimension>& x) {
  auto f = detail::make_vector<T>(system);
  force<T>(system, x.q, f);
  phase_point<T, S::dimension> between = x;
  for (Eigen::Index i = 0; i < x.size(); ++i) between.p[i] += f[i] * (0.5 * step);
  return kinetic_temperature<T>(system, between);
}

// Statistics along trajectories in lanes, and the part of each that is kept.

/// The statistics of an ensemble that are wanted; others cost nothing.
struct statistics_wanted {
  std::optional<equal_bins> histogram = {};    ///< bins for the observable
  std::optional<int> lags = {};                ///< lags of the autocovariance
  bool moments = false;                        ///< mean and variance, with the effective sample size
  bool kinetic_temperature = false;            ///< kinetic temperature of the momenta at the steps
  bool half_step_kinetic_temperature = false;  ///< kinetic temperature between steps; costs a force a sample
  std::int64_t from = 0;                       ///< the first step that counts
};

namespace detail {

/// Result of one trajectory: its means over time.
struct time_means {
  double first = 0.0;      ///< first moment: mean of the observable less the centre
  double second = 0.0;     ///< second moment: mean of the square of that difference
  double kinetic = 0.0;    ///< kinetic temperature at the steps
  double half_step = 0.0;  ///< kinetic temperature between steps
};

/// Accumulates what is wanted of the trajectories in the lanes of T. The bits of each do not depend on the
/// lanes.
template <class T>
class statistics_along {
 public:
  /// Refers to what is wanted.
  statistics_along(const statistics_wanted& wanted, double centre) : wanted_(&wanted), centre_(centre) {
    if (wanted.histogram) histogram_.emplace(*wanted.histogram);
    if (wanted.lags) autocovariance_.emplace(*wanted.lags, centre);
  }

  /// How many numbers are read of a state, 1 to 3.
  std::size_t width() const {
    return 1U + (wanted_->kinetic_temperature ? 1U : 0U) + (wanted_->half_step_kinetic_temperature ? 1U : 0U);
  }

  /// Writes them: the observable, then the temperatures.
  template <class Stepper>
  void read_of(const Stepper& stepper, const auto& observable, const phase_point<T, Stepper::dimension>& x,
               std::span<T> numbers) const {
    T* next = numbers.data();
    *next++ = value_in_lanes<T>(observable, x);
    if (wanted_->kinetic_temperature) *next++ = kinetic_temperature<T>(stepper.system(), x);
    if (wanted_->half_step_kinetic_temperature) {
      *next++ = half_step_kinetic_temperature<T>(stepper.system(), stepper.step_size(), x);
    }
  }

  /// Takes the numbers of step n. A lane in which one is not finite is lost there.
  void see(std::int64_t n, std::span<const T> numbers, const condition_of<T>& live) {
    T all = numbers[0];
    for (const T& number : numbers.subspan(1)) all += number;
    const auto lost = both(!(all - all == T(0.0)), live);  // NOLINT(misc-redundant-expression): NaN, infinity
    lost_at_.take(lost, n);
    if (n < wanted_->from) return;
    samples_ += 1.0;
    if (histogram_) histogram_->add(numbers[0]);
    if (autocovariance_) autocovariance_->add(numbers[0]);
    std::size_t i = 1;
    if (wanted_->moments) add_moments(numbers[0] - centre_);
    if (wanted_->kinetic_temperature) kinetic_ += numbers[i++];
    if (wanted_->half_step_kinetic_temperature) half_step_ += numbers[i++];
  }

  /// The first step at which lane k was not finite.
  std::optional<std::int64_t> lost_at(int k) const { return lost_at_[k]; }
  /// The histogram of lane k, where one is wanted.
  const histogram& histogram_in_lane(int k) const { return histogram_->in_lane(k); }
  /// The autocovariance of lane k, where one is wanted. Throws like autocovariance_along::in_lane().
  autocovariance_sums autocovariance_in_lane(int k) { return autocovariance_->in_lane(k); }
  /// The means of lane k over its samples; 0 for what is not wanted.
  time_means means_in_lane(int k) const {
    return {lane(first_, k) / samples_, lane(second_, k) / samples_, lane(kinetic_, k) / samples_,
            lane(half_step_, k) / samples_};
  }

 private:
  void add_moments(const T& y) {
    first_ += y;
    second_ += y * y;
  }

  const statistics_wanted* wanted_;
  double centre_;
  double samples_ = 0.0;
  std::optional<histogram_along<T>> histogram_;
  std::optional<autocovariance_along<T>> autocovariance_;
  T first_{0.0};
  T second_{0.0};
  T kinetic_{0.0};
  T half_step_{0.0};
  first_in_lanes<T> lost_at_{};
};

}  // namespace detail

// The statistics of an ensemble, put together from the statistics of its trajectories.

/// Statistics of all trajectories. Those that were not requested are empty or NaN.
struct gathered_statistics {
  std::int64_t counted = 0;                              ///< trajectories that reached their end
  std::int64_t samples = 0;                              ///< samples of each trajectory
  std::vector<diverged_trajectory> lost;                 ///< diverged trajectories, by rising number
  std::optional<nysalt::histogram> histogram;            ///< histogram of the observable, all trajectories
  std::vector<nysalt::histogram> histogram_of_groups;    ///< 33 to 64 groups of trajectories, for a jackknife
  std::optional<nysalt::autocovariance> autocovariance;  ///< autocovariance of the observable, with its error
  estimate mean;  ///< mean of the observable, over independent trajectories
  double variance = std::numeric_limits<double>::quiet_NaN();  ///< variance of the observable
  /// Independent samples that would know the mean as well: variance/(error of the mean)^2.
  double effective_sample_size = std::numeric_limits<double>::quiet_NaN();
  estimate kinetic_temperature;            ///< kT of the momenta at the steps
  estimate half_step_kinetic_temperature;  ///< kT of those between the steps
};

namespace detail {

/// Trajectories of one group of the jackknife, set by their number only: 33 to 64 groups, if there are as
/// many trajectories. A divisor of 16, or a multiple: then groups, lanes and threads fit together.
std::int64_t trajectories_of_group(std::int64_t trajectories);

/// Keeps the sums of each group of trajectories, and a few numbers of each trajectory. Threads may keep
/// trajectories of different groups at a time; trajectories of one group are kept in their order. A rank
/// keeps whole shares of threads.
class gathering {
 public:
  /// Refers to what is wanted, and to the ranks. `interval` is the time between samples.
  gathering(const statistics_wanted& wanted, std::int64_t trajectories, std::int64_t samples, double interval,
            double centre, const communicator& ranks);

  /// Number of consecutive trajectories of one thread.
  int trajectories_of_thread() const { return static_cast<int>(std::max<std::int64_t>(group_size_, 16)); }
  /// The trajectories of this rank, from number 0 on.
  const shard& share() const { return share_; }

  /// Keeps trajectory m, from 0 on, which is in lane k; of one that is lost, only where.
  template <class T>
  void keep(std::int64_t m, statistics_along<T>& along, int k, std::optional<std::int64_t> lost_at) {
    const auto slot = static_cast<std::size_t>(m);
    const auto group = static_cast<std::size_t>(m / group_size_);
    lost_at_[slot] = lost_at;
    if (lost_at) return;
    means_[slot] = along.means_in_lane(k);
    if (wanted_->histogram) histograms_[group] += along.histogram_in_lane(k);
    if (wanted_->lags) {
      const autocovariance_sums sums = along.autocovariance_in_lane(k);
      for (std::size_t lag = 0; lag < sums.size(); ++lag)
        covariances_[group][lag] = covariances_[group][lag] + sums[lag];
    }
  }

  /// Collective: each rank has kept its own trajectories, and all get all.
  void gather();

  /// The statistics, when all are kept and gathered; `first` is the number of trajectory 0.
  gathered_statistics result(std::int64_t first);

 private:
  void gather_histograms();
  void gather_covariances();

  estimate over_trajectories(double time_means::*mean) const;
  void set_moments(gathered_statistics& all) const;

  const statistics_wanted* wanted_;
  std::int64_t samples_;
  double interval_;
  double centre_;
  std::int64_t group_size_;
  shard share_;
  std::vector<std::optional<std::int64_t>> lost_at_;
  std::vector<time_means> means_;
  std::vector<histogram> histograms_;
  std::vector<autocovariance_sums> covariances_;
};

}  // namespace detail

// Statistics of an ensemble of trajectories, none of which is kept.

namespace detail {

/// Samples of a trajectory: the steps from..steps that `every` divides. Throws std::invalid_argument if the
/// options are out of range, or lags need more samples.
std::int64_t samples_of_trajectory(const ensemble_options& options, const statistics_wanted& wanted);

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
    using state = phase_point<T, Stepper::dimension>;
    struct measured : detail::statistics_along<T> {
      const Stepper& stepper;
      const Observable& observable;
      detail::gathering& all;
      std::int64_t place;
      int count;

      void read(const state& x, std::span<T> numbers) const {
        this->read_of(stepper, observable, x, numbers);
      }
      void end(const detail::lockstep<Stepper, T>& run) {
        for (int k = 0; k < count; ++k) {
          const auto lost_at = this->lost_at(k);
          all.keep(place + k, *this, k, lost_at ? lost_at : run.diverged_at(k));
        }
      }
    };
    const std::int64_t samples = detail::samples_of_trajectory(options, wanted);
    const state start = detail::sound_starts<T>(stepper.system(), ensemble, options.seed, options.first, 1);
    // Any number near the mean, the same for all.
    const double seen_first = lane(value_in_lanes<T>(observable, start), 0);
    const double centre = std::isfinite(seen_first) ? seen_first : 0.0;
    const double interval = static_cast<double>(options.every) * stepper.step_size();
    detail::gathering all(wanted, options.trajectories, samples, interval, centre, *options.execution.ranks);
    detail::measure_ensemble<T>(
        stepper, ensemble, options, all.share(), all.trajectories_of_thread(),
        [&](std::int64_t place, int count) {
          return measured{
              detail::statistics_along<T>(wanted, centre), stepper, observable, all, place, count};
        });
    all.gather();
    return all.result(options.first);
  });
}

}  // namespace nysalt
