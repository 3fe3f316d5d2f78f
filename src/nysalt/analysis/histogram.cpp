// SPDX-License-Identifier: BSL-1.0
#include "nysalt/analysis/histogram.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <vector>

namespace nysalt {

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

}  // namespace nysalt
