// SPDX-License-Identifier: BSL-1.0

#include "nysalt/analysis/statistics.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "jackknife.hpp"
#include "nysalt/core/tree_sum.hpp"

namespace nysalt {

namespace {

double count_of(std::span<const double> numbers) {
  return static_cast<double>(std::ranges::count_if(numbers, [](double x) { return !std::isnan(x); }));
}

/// The tree_sum of term(x) over the numbers x, in which NaN adds 0.
double sum_over(std::span<const double> numbers, const auto& term) {
  std::vector<double> terms;
  for (const double x : numbers) terms.push_back(std::isnan(x) ? 0.0 : term(x));
  return tree_sum(terms);
}

}  // namespace

estimate mean_and_error(std::span<const double> samples) {
  const double n = count_of(samples);
  if (n == 0.0) return {};
  const double mean = sum_over(samples, std::identity()) / n;
  if (n < 2.0) return {mean, std::numeric_limits<double>::quiet_NaN()};
  const double variance = sum_over(samples, [&](double x) { return (x - mean) * (x - mean); }) / (n - 1.0);
  return {mean, std::sqrt(variance / n)};
}

estimate paired_difference(std::span<const double> a, std::span<const double> b) {
  std::vector<double> differences(a.begin(), a.end());
  for (std::size_t i = 0; i < a.size(); ++i) differences[i] -= b[i];
  return mean_and_error(differences);
}

double median(std::vector<double> samples) {
  if (samples.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::ranges::sort(samples);
  const double upper = samples[samples.size() / 2];
  const double lower = samples[(samples.size() - 1) / 2];
  return lower == upper ? upper : 0.5 * (lower + upper);
}

std::vector<double> detail::sorted_numbers(std::vector<double> samples) {
  std::erase_if(samples, [](double x) { return std::isnan(x); });
  std::ranges::sort(samples);
  return samples;
}

double quantile(std::span<const double> sorted, double p) {
  if (sorted.empty()) return std::numeric_limits<double>::quiet_NaN();
  const double at = p * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  if (below + 1 == sorted.size()) return sorted[below];
  return sorted[below] + (at - static_cast<double>(below)) * (sorted[below + 1] - sorted[below]);
}

estimate detail::median_and_error(std::span<const double> sorted) {
  estimate result{quantile(sorted, 0.5), std::numeric_limits<double>::quiet_NaN()};
  if (sorted.size() < 2) return result;
  const double off = 0.5 / std::sqrt(static_cast<double>(sorted.size()));
  const double above = quantile(sorted, std::min(0.5 + off, 1.0));
  result.standard_error = 0.5 * (above - quantile(sorted, std::max(0.5 - off, 0.0)));
  return result;
}

double slope(std::span<const double> x, std::span<const double> y) {
  const double mean_x = mean_and_error(x).mean;
  const double mean_y = mean_and_error(y).mean;
  double xy = 0.0;
  double xx = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xy += (x[i] - mean_x) * (y[i] - mean_y);
    xx += (x[i] - mean_x) * (x[i] - mean_x);
  }
  return xy / xx;
}

tail tail_of(std::span<const double> numbers) {
  tail result{.count = count_of(numbers)};
  double largest = 0.0;
  for (const double x : numbers) {
    if (std::abs(x) > largest) largest = std::abs(x);
  }
  if (largest == 0.0) return result;
  // In units of the largest: no power of a small number underflows.
  const auto mean_of = [&](const auto& term) {
    return sum_over(numbers, [&](double x) { return term(x / largest); }) / result.count;
  };
  const double mean = mean_of(std::identity());
  const double variance = mean_of([&](double x) { return (x - mean) * (x - mean); });
  const double third = mean_of([&](double x) { return (x - mean) * (x - mean) * (x - mean); });
  result.deciding = result.count * mean * mean / (variance + mean * mean);
  // What differs only by rounding is equal: half a unit in the last place of each number and of the mean.
  const double deviation = std::sqrt(variance);
  if (deviation > std::numeric_limits<double>::epsilon()) {
    result.skewness = third / (variance * deviation);
  }
  return result;
}

histogram::histogram(const equal_bins& bins) : bins_(bins), per_width_(1.0 / bins.width()) {
  constexpr int most = 100'000;  // one histogram a lane and a group of trajectories must fit into memory
  const bool sound = bins.low < bins.high && std::isfinite(per_width_) && per_width_ > 0.0;
  if (!sound || bins.count < 1 || bins.count > most) {
    throw std::invalid_argument(
        fmt::format("histogram: count must be 1 to {}, and low < high and finite, got {} bins from {} to {}",
                    most, bins.count, bins.low, bins.high));
  }
  counts_.resize(static_cast<std::size_t>(bins.count) + 2);
}

histogram::histogram(const equal_bins& bins, std::span<const std::int64_t> counts) : histogram(bins) {
  if (counts.size() != counts_.size()) {
    throw std::invalid_argument(
        fmt::format("histogram: counts must be those of the bins, below and above, got {} for {} bins",
                    counts.size(), bins.count));
  }
  counts_.assign(counts.begin(), counts.end());
}

void histogram::add(double x) {
  if (std::isnan(x)) throw std::invalid_argument("histogram: values must be numbers, got NaN");
  count(place(x));
}

histogram& histogram::operator+=(const histogram& other) {
  require_bins_of(other);
  for (std::size_t i = 0; i < counts_.size(); ++i) counts_[i] += other.counts_[i];
  return *this;
}

histogram& histogram::operator-=(const histogram& other) {
  require_bins_of(other);
  for (std::size_t i = 0; i < counts_.size(); ++i) counts_[i] -= other.counts_[i];
  return *this;
}

std::vector<double> histogram::fractions() const {
  const auto all = static_cast<double>(total());
  if (all == 0.0)
    throw std::invalid_argument("histogram: values must be one or more for fractions, got none");
  std::vector<double> result;
  for (const std::int64_t n : counts_) result.push_back(static_cast<double>(n) / all);
  return result;
}

std::vector<double> histogram::density() const {
  const auto all = fractions();
  std::vector<double> result(all.begin() + 1, all.end() - 1);
  for (double& fraction : result) fraction /= bins_.width();
  return result;
}

void histogram::require_bins_of(const histogram& other) const {
  if (bins_ == other.bins_) return;
  throw std::invalid_argument(fmt::format(
      "histogram: both must have the same bins, got {} bins from {} to {} and {} bins from {} to {}",
      bins_.count, bins_.low, bins_.high, other.bins_.count, other.bins_.low, other.bins_.high));
}

detail::sample_weights::sample_weights(double step, std::int64_t samples, double horizon)
    : samples_(samples),
      is_alike_(false),
      last_(horizon / std::abs(step) - static_cast<double>(samples - 1)) {
  constexpr double rounding = 1e-9;  // of horizon/step: as where steps are counted
  const double most = 1.0 + rounding * static_cast<double>(samples);
  if (samples >= 1 && last_ > 0.0 && last_ <= most) return;
  throw std::invalid_argument(fmt::format(
      "sample_weights: horizon must lie within the last of {} steps of {}, got {}", samples, step, horizon));
}

integrated_time integrated_autocorrelation_time(std::span<const double> rho) {
  if (rho.size() < 2)
    throw std::invalid_argument("integrated_autocorrelation_time: lags must be one or more, got none");
  integrated_time result;
  for (std::size_t k = 1; k < rho.size(); ++k) {
    result.tau += 2.0 * rho[k];
    result.memory += 2.0 * std::abs(rho[k]);
    result.window = k;
    result.enough = static_cast<double>(k) >= 5.0 * result.memory && result.tau > 0.0;
    if (static_cast<double>(k) >= 5.0 * result.memory) break;
  }
  return result;
}

double effective_sample_size(double samples, const integrated_time& time) {
  if (!time.enough) return std::nan("");
  const double error = time.memory * std::sqrt((4.0 * static_cast<double>(time.window) + 2.0) / samples);
  return samples / std::max(time.tau, 2.0 * error);
}

std::size_t detail::checked_lags(int lags) {
  constexpr int most = 100'000;
  if (1 <= lags && lags <= most) return static_cast<std::size_t>(lags);
  throw std::invalid_argument(fmt::format("autocovariance: lags must be 1 to {}, got {}", most, lags));
}

std::vector<double> autocovariance::jackknife(
    const std::function<std::vector<double>(const std::vector<double>&)>& f) const {
  const std::vector<double> all = f(normalised());
  std::vector<std::vector<double>> without(all.size());  // number i, without each of the groups
  if (groups_.size() >= 2) {
    for (const auto& group : groups_) {
      detail::autocovariance_sums others = total_;
      for (std::size_t k = 0; k < others.size(); ++k) others[k] = others[k] - group[k];
      const std::vector<double> numbers = f(normalised(others));
      for (std::size_t i = 0; i < all.size(); ++i) without[i].push_back(numbers[i]);
    }
  }
  std::vector<double> variances;
  for (std::size_t i = 0; i < all.size(); ++i) {
    variances.push_back(detail::jackknife_variance(without[i], all[i]));
  }
  return variances;
}

autocovariance::autocovariance(double interval, double centre,
                               std::vector<detail::autocovariance_sums> groups)
    : interval_(interval), centre_(centre) {
  if (groups.empty())
    throw std::invalid_argument("autocovariance: groups of trajectories must be one or more, got none");
  total_.resize(groups.front().size());
  for (auto& group : groups) {
    if (group.size() != total_.size()) {
      throw std::invalid_argument(fmt::format("autocovariance: groups must have equal lags, got {} and {}",
                                              lags(), group.size() - 1));
    }
    if (group.front().pairs == 0.0) continue;
    for (std::size_t k = 0; k < total_.size(); ++k) total_[k] = total_[k] + group[k];
    groups_.push_back(std::move(group));
  }
}

std::vector<double> autocovariance::standard_error() const {
  std::vector<double> result = jackknife([](const std::vector<double>& rho) { return rho; });
  for (double& value : result) value = std::sqrt(value);
  return result;
}

std::vector<double> autocovariance::normalised(const detail::autocovariance_sums& sums) {
  const double variance = sums.front().covariance();
  if (!(variance > 0.0)) {
    throw std::runtime_error(
        "autocovariance: the variance must be > 0, got none: the observable does not vary, "
        "or no trajectory counts");
  }
  std::vector<double> rho;
  for (const detail::pair_sums& at : sums) rho.push_back(at.covariance() / variance);
  return rho;
}

autocovariance::distance acf_error(const autocovariance& a, const autocovariance& b) {
  if (a.lags() != b.lags() || std::abs(a.interval() - b.interval()) > 1e-9 * std::abs(a.interval())) {
    throw std::invalid_argument(
        fmt::format("acf_error: both autocovariances must have the same lags, got {} lags of {} and {} "
                    "lags of {}; sample both at the same times",
                    a.lags(), a.interval(), b.lags(), b.interval()));
  }
  using numbers = std::vector<double>;
  const auto over_lags = [](const numbers& at, const numbers& other, auto&& term) {
    double sum = 0.0;
    for (std::size_t k = 1; k < at.size(); ++k) sum += term(at[k], other[k]);
    return std::sqrt(sum / static_cast<double>(at.size() - 1));
  };
  const auto distance = [&](const numbers& x, const numbers& y) {
    return over_lags(x, y, [](double u, double v) { return (u - v) * (u - v); });
  };
  const numbers rho_a = a.normalised();
  const numbers rho_b = b.normalised();
  const numbers from_a = a.jackknife([&](const numbers& rho) { return numbers{distance(rho, rho_b)}; });
  const numbers from_b = b.jackknife([&](const numbers& rho) { return numbers{distance(rho, rho_a)}; });
  const double floor =
      over_lags(a.standard_error(), b.standard_error(), [](double u, double v) { return u * u + v * v; });
  return {distance(rho_a, rho_b), std::sqrt(from_a[0] + from_b[0]), floor};
}

namespace {

histogram sum_of(std::span<const histogram> groups) {
  if (groups.empty())
    throw std::invalid_argument("total_variation: groups of trajectories must be one or more, got none");
  histogram all(groups.front().bins());
  for (const histogram& group : groups) all += group;
  return all;
}

/// The variance of distance(all) by the jackknife over groups; groups without a trajectory do not count.
template <class Distance>
double jackknife_variance(std::span<const histogram> groups, const histogram& all, const Distance& distance) {
  std::vector<double> without;
  for (const histogram& group : groups) {
    if (group.total() == 0) continue;
    histogram others = all;
    others -= group;
    if (others.total() > 0) without.push_back(distance(others));
  }
  return detail::jackknife_variance(without, distance(all));
}

}  // namespace

double total_variation(const histogram& a, const histogram& b) {
  a.require_bins_of(b);
  const auto p = a.fractions();
  const auto q = b.fractions();
  double sum = 0.0;
  for (std::size_t i = 0; i < p.size(); ++i) sum += std::abs(p[i] - q[i]);
  return 0.5 * sum;
}

double mean_total_variation(const histogram& given, std::span<const histogram> ensembles) {
  if (ensembles.empty())
    throw std::invalid_argument(
        "mean_total_variation: ensembles to compare with must be one or more, got none");
  double sum = 0.0;
  for (const histogram& other : ensembles) sum += total_variation(given, other);
  return sum / static_cast<double>(ensembles.size());
}

estimate mean_total_variation(std::span<const histogram> groups,
                              std::span<const std::vector<histogram>> ensembles) {
  const histogram given = sum_of(groups);
  std::vector<histogram> others;
  for (const auto& ensemble : ensembles) others.push_back(sum_of(ensemble));
  const double mean = mean_total_variation(given, others);
  double variance = jackknife_variance(
      groups, given, [&](const histogram& without) { return mean_total_variation(without, others); });
  const auto count = static_cast<double>(others.size());
  for (std::size_t k = 0; k < others.size(); ++k) {
    variance += jackknife_variance(ensembles[k], others[k], [&](const histogram& without) {
      return total_variation(given, without) / count;
    });
  }
  return {mean, std::sqrt(variance)};
}

double sampling_floor(std::span<const histogram> ensembles) {
  if (ensembles.size() < 4) {
    throw std::invalid_argument(fmt::format(
        "sampling_floor: independent ensembles must be 4 or more (6 pairs), got {}", ensembles.size()));
  }
  double sum = 0.0;
  double pairs = 0.0;
  for (std::size_t i = 0; i < ensembles.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      sum += total_variation(ensembles[i], ensembles[j]);
      pairs += 1.0;
    }
  }
  return sum / pairs;
}

}  // namespace nysalt
