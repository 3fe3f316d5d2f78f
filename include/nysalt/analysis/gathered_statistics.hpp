// SPDX-License-Identifier: BSL-1.0
// The statistics of an ensemble, put together from those of its trajectories.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "nysalt/analysis/autocovariance.hpp"
#include "nysalt/analysis/statistics.hpp"
#include "nysalt/analysis/statistics_along.hpp"
#include "nysalt/communicator.hpp"
#include "nysalt/detail/divergence.hpp"

namespace nysalt {

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

/// Trajectories of one group of the jackknife, set by their number only: 33 to 64 groups, if there are as
/// many trajectories. A divisor of 16, or a multiple: then groups, lanes and threads fit together.
std::int64_t trajectories_of_group(std::int64_t trajectories);

/// Keeps the sums of each group of trajectories, and a few numbers of each trajectory. Threads may keep
/// trajectories of different groups at a time; those of one group are kept in their order. A rank keeps the
/// trajectories first() .. first() + count() - 1: some of the shares of a thread, one after the other.
class gathering {
 public:
  /// Refers to what is wanted, and to the ranks. `interval` is the time between samples.
  gathering(const statistics_wanted& wanted, std::int64_t trajectories, std::int64_t samples, double interval,
            double centre, const communicator& ranks);

  /// Number of consecutive trajectories of one thread.
  int trajectories_of_thread() const { return static_cast<int>(std::max<std::int64_t>(group_size_, 16)); }
  /// Number of the first trajectory that this rank keeps, from 0.
  std::int64_t first() const { return first_of(ranks_->rank()); }
  std::int64_t count() const {
    return first_of(ranks_->rank() + 1) - first();
  }  ///< number of trajectories of this rank

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
  /// First trajectory of a rank; of rank size() the number of all trajectories.
  std::int64_t first_of(int rank) const;
  /// All-gather of lists that hold that number of items for each trajectory, or for each group.
  template <class Item>
  void gather(std::vector<Item>& all, std::size_t items, std::int64_t trajectories_of_item = 1) const;
  void gather_histograms();
  void gather_covariances();

  estimate over_trajectories(double time_means::*mean) const;
  void set_moments(gathered_statistics& all) const;

  const statistics_wanted* wanted_;
  const communicator* ranks_;
  std::int64_t samples_;
  double interval_;
  double centre_;
  std::int64_t group_size_;
  std::vector<std::optional<std::int64_t>> lost_at_;
  std::vector<time_means> means_;
  std::vector<histogram> histograms_;
  std::vector<autocovariance_sums> covariances_;
};

}  // namespace nysalt
