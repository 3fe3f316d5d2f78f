// SPDX-License-Identifier: BSL-1.0
// The statistics of an ensemble, put together from those of its trajectories.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "nysalt/analysis/autocovariance.hpp"
#include "nysalt/analysis/statistics.hpp"
#include "nysalt/analysis/statistics_along.hpp"
#include "nysalt/communicator.hpp"
#include "nysalt/divergence.hpp"

namespace nysalt {

/// What was not wanted is empty or NaN.
struct gathered_statistics {
  std::int64_t counted = 0;                              ///< trajectories that reached their end
  std::int64_t samples = 0;                              ///< of each of them
  std::vector<diverged_trajectory> lost;                 ///< in the order of their numbers
  std::optional<nysalt::histogram> histogram;            ///< of the observable, all trajectories
  std::vector<nysalt::histogram> histogram_of_groups;    ///< 33 to 64 groups of trajectories, for a jackknife
  std::optional<nysalt::autocovariance> autocovariance;  ///< of the observable, with its error
  estimate mean;                                         ///< of the observable, over independent trajectories
  double variance = std::numeric_limits<double>::quiet_NaN();  ///< of the observable
  /// Independent samples that would know the mean as well: variance/(error of the mean)^2.
  double effective_sample_size = std::numeric_limits<double>::quiet_NaN();
  estimate kinetic_temperature;            ///< kT of the momenta at the steps
  estimate half_step_kinetic_temperature;  ///< kT of those between the steps
};

/// Trajectories of one group of the jackknife, set by their number alone: 33 to 64 groups, if there are as
/// many trajectories. A divisor of 16, or a multiple: then groups, lanes and threads fit together.
inline std::int64_t trajectories_of_group(std::int64_t trajectories) {
  constexpr std::int64_t groups = 64;
  std::int64_t size = 1;
  while (size < 16 && size * groups < trajectories) size *= 2;
  return size < 16 ? size : 16 * ((trajectories - 1) / (16 * groups) + 1);
}

/// Keeps the sums of each group of trajectories, and a few numbers of each trajectory. Threads may keep
/// trajectories of different groups at a time; those of one group are kept in their order. A rank keeps the
/// trajectories first() .. first() + count() - 1: some of the shares of a thread, one after the other.
class gathering {
 public:
  /// Refers to what is wanted, and to the ranks. `interval` is the time between samples.
  gathering(const statistics_wanted& wanted, std::int64_t trajectories, std::int64_t samples, double interval,
            double centre, const communicator& ranks)
      : wanted_(&wanted),
        ranks_(&ranks),
        samples_(samples),
        interval_(interval),
        centre_(centre),
        group_size_(trajectories_of_group(trajectories)),
        lost_at_(static_cast<std::size_t>(trajectories)),
        means_(lost_at_.size()) {
    const auto groups = static_cast<std::size_t>((trajectories - 1) / group_size_ + 1);
    if (wanted.histogram) histograms_.assign(groups, histogram(*wanted.histogram));
    if (wanted.lags) covariances_.assign(groups, autocovariance_sums(checked_lags(*wanted.lags) + 1));
  }

  /// Of how many consecutive trajectories one thread takes care.
  int trajectories_of_thread() const { return static_cast<int>(std::max<std::int64_t>(group_size_, 16)); }
  /// Number of the first trajectory that this rank keeps, from 0.
  std::int64_t first() const { return first_of(ranks_->rank()); }
  std::int64_t count() const { return first_of(ranks_->rank() + 1) - first(); }  ///< how many this rank keeps

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
      const autocovariance_sums its = along.autocovariance_in_lane(k);
      for (std::size_t lag = 0; lag < its.size(); ++lag)
        covariances_[group][lag] = covariances_[group][lag] + its[lag];
    }
  }

  /// Collective: each rank has kept its own trajectories, and all get all.
  void gather() {
    if (ranks_->is_alone()) return;
    gather(lost_at_, 1);
    gather(means_, 1);
    if (wanted_->histogram) gather_histograms();
    if (wanted_->lags) gather_covariances();
  }

  /// The statistics, when all are kept and gathered; `first` is the number of trajectory 0.
  gathered_statistics result(std::int64_t first) {
    gathered_statistics all;
    all.samples = samples_;
    for (std::size_t m = 0; m < lost_at_.size(); ++m) {
      if (lost_at_[m]) all.lost.push_back({first + static_cast<std::int64_t>(m), *lost_at_[m]});
    }
    all.counted = std::ssize(lost_at_) - std::ssize(all.lost);
    for (const histogram& group : histograms_) {
      if (!all.histogram) all.histogram.emplace(group.bins());
      *all.histogram += group;
    }
    all.histogram_of_groups = std::move(histograms_);
    if (wanted_->lags) all.autocovariance.emplace(interval_, centre_, std::move(covariances_));
    if (wanted_->moments) set_moments(all);
    if (wanted_->kinetic_temperature) all.kinetic_temperature = over_trajectories(&time_means::kinetic);
    if (wanted_->half_step_kinetic_temperature)
      all.half_step_kinetic_temperature = over_trajectories(&time_means::half_step);
    return all;
  }

 private:
  /// That of rank size() is the number of all.
  std::int64_t first_of(int rank) const {
    const std::int64_t all = std::ssize(lost_at_);
    const std::int64_t shares = (all - 1) / trajectories_of_thread() + 1;
    return std::min(all, first_of_part(shares, rank, ranks_->size()) * trajectories_of_thread());
  }
  /// Of lists that hold so many items for each trajectory, or for each group.
  template <class Item>
  void gather(std::vector<Item>& all, std::size_t items, std::int64_t trajectories_of_item = 1) const {
    std::vector<std::size_t> first_of_rank;
    for (int r = 0; r <= ranks_->size(); ++r) {
      const std::int64_t first = (first_of(r) + trajectories_of_item - 1) / trajectories_of_item;
      first_of_rank.push_back(static_cast<std::size_t>(first) * items);
    }
    gather_items(*ranks_, all, first_of_rank);
  }
  void gather_histograms() {
    std::vector<std::int64_t> all;
    for (const histogram& group : histograms_) {
      all.insert(all.end(), group.counts().begin(), group.counts().end());
    }
    const std::size_t bins = histograms_.front().counts().size();
    gather(all, bins, group_size_);
    for (std::size_t g = 0; g < histograms_.size(); ++g) {
      histograms_[g] = histogram(*wanted_->histogram, std::span(all).subspan(g * bins, bins));
    }
  }
  void gather_covariances() {
    std::vector<pair_sums> all;
    for (const autocovariance_sums& group : covariances_) all.insert(all.end(), group.begin(), group.end());
    const std::size_t lags = covariances_.front().size();
    gather(all, lags, group_size_);
    for (std::size_t g = 0; g < covariances_.size(); ++g) {
      std::ranges::copy(std::span(all).subspan(g * lags, lags), covariances_[g].begin());
    }
  }

  estimate over_trajectories(double time_means::*mean) const {
    std::vector<double> of_each;
    for (std::size_t m = 0; m < means_.size(); ++m) {
      of_each.push_back(lost_at_[m] ? std::numeric_limits<double>::quiet_NaN() : means_[m].*mean);
    }
    return mean_and_error(of_each);
  }
  void set_moments(gathered_statistics& all) const {
    const estimate mean = over_trajectories(&time_means::first);
    const double squared_error = mean.standard_error * mean.standard_error;
    all.mean = {centre_ + mean.mean, mean.standard_error};
    // The spread about the samples' own mean is too small by the error of that mean.
    all.variance = over_trajectories(&time_means::second).mean - mean.mean * mean.mean + squared_error;
    all.effective_sample_size = all.variance / squared_error;
  }

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
