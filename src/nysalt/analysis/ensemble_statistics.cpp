// SPDX-License-Identifier: BSL-1.0

#include "nysalt/analysis/ensemble_statistics.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

namespace nysalt {

std::int64_t detail::trajectories_of_group(std::int64_t trajectories) {
  constexpr std::int64_t groups = 64;
  std::int64_t size = 1;
  while (size < 16 && size * groups < trajectories) size *= 2;
  return size < 16 ? size : 16 * ((trajectories - 1) / (16 * groups) + 1);
}

detail::gathering::gathering(const statistics_wanted& wanted, std::int64_t trajectories, std::int64_t samples,
                             double interval, double centre, const communicator& ranks)
    : wanted_(&wanted),
      samples_(samples),
      interval_(interval),
      centre_(centre),
      group_size_(detail::trajectories_of_group(trajectories)),
      share_(trajectories, ranks, trajectories_of_thread()),
      lost_at_(static_cast<std::size_t>(trajectories)),
      means_(lost_at_.size()) {
  const auto groups = static_cast<std::size_t>((trajectories - 1) / group_size_ + 1);
  if (wanted.histogram) histograms_.assign(groups, histogram(*wanted.histogram));
  if (wanted.lags)
    covariances_.assign(groups, detail::autocovariance_sums(detail::checked_lags(*wanted.lags) + 1));
}

void detail::gathering::gather() {
  if (share_.ranks().is_single()) return;
  share_.gather(lost_at_);
  share_.gather(means_);
  if (wanted_->histogram) gather_histograms();
  if (wanted_->lags) gather_covariances();
}

gathered_statistics detail::gathering::result(std::int64_t first) {
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
  if (wanted_->kinetic_temperature) all.kinetic_temperature = over_trajectories(&detail::time_means::kinetic);
  if (wanted_->half_step_kinetic_temperature)
    all.half_step_kinetic_temperature = over_trajectories(&detail::time_means::half_step);
  return all;
}

void detail::gathering::gather_histograms() {
  std::vector<std::int64_t> all;
  for (const histogram& group : histograms_) {
    all.insert(all.end(), group.counts().begin(), group.counts().end());
  }
  const std::size_t bins = histograms_.front().counts().size();
  share_.gather(all, static_cast<std::int64_t>(bins), group_size_);
  for (std::size_t g = 0; g < histograms_.size(); ++g) {
    histograms_[g] = histogram(*wanted_->histogram, std::span(all).subspan(g * bins, bins));
  }
}

void detail::gathering::gather_covariances() {
  std::vector<detail::pair_sums> all;
  for (const detail::autocovariance_sums& group : covariances_)
    all.insert(all.end(), group.begin(), group.end());
  const std::size_t lags = covariances_.front().size();
  share_.gather(all, static_cast<std::int64_t>(lags), group_size_);
  for (std::size_t g = 0; g < covariances_.size(); ++g) {
    std::ranges::copy(std::span(all).subspan(g * lags, lags), covariances_[g].begin());
  }
}

estimate detail::gathering::over_trajectories(double detail::time_means::*mean) const {
  std::vector<double> of_each;
  for (std::size_t m = 0; m < means_.size(); ++m) {
    of_each.push_back(lost_at_[m] ? std::numeric_limits<double>::quiet_NaN() : means_[m].*mean);
  }
  return mean_and_error(of_each);
}

void detail::gathering::set_moments(gathered_statistics& all) const {
  const estimate mean = over_trajectories(&detail::time_means::first);
  const double squared_error = mean.standard_error * mean.standard_error;
  all.mean = {centre_ + mean.mean, mean.standard_error};
  // The spread about the samples' own mean is too small by the error of that mean.
  all.variance = over_trajectories(&detail::time_means::second).mean - mean.mean * mean.mean + squared_error;
  all.effective_sample_size = all.variance / squared_error;
}

std::int64_t detail::samples_of_trajectory(const ensemble_options& options, const statistics_wanted& wanted) {
  detail::require_ensemble("ensemble_statistics", options);
  if (wanted.from < 0 || wanted.from > options.steps) {
    throw std::invalid_argument(fmt::format("ensemble_statistics: from must be 0 to steps, got from {} of {}",
                                            wanted.from, options.steps));
  }
  const std::int64_t before = wanted.from == 0 ? 0 : (wanted.from - 1) / options.every + 1;
  const std::int64_t samples = options.steps / options.every + 1 - before;
  if (samples > wanted.lags.value_or(0)) return samples;
  throw std::invalid_argument(
      fmt::format("ensemble_statistics: samples along a trajectory must exceed the lags, got {} "
                  "samples for {} lags; take more steps or fewer lags",
                  samples, wanted.lags.value_or(0)));
}

}  // namespace nysalt
