// SPDX-License-Identifier: BSL-1.0
// How often a number fell where.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <stdexcept>
#include <vector>

#include "nysalt/lanes.hpp"

namespace nysalt {

/// `count` bins of equal width on [low, high]. A number on an edge belongs to the bin above it, to rounding;
/// `high` itself to the last bin.
struct equal_bins {
  double low;   ///< where the first bin begins
  double high;  ///< where the last bin ends
  int count;    ///< number of bins

  double width() const { return (high - low) / count; }                    ///< of a bin
  friend bool operator==(const equal_bins&, const equal_bins&) = default;  ///< equal in all
};

/// Counts in equal bins, and in two further ones for what lies below and above. They are integers: the order
/// of adding, lanes and threads change nothing.
class histogram {
 public:
  /// Empty. Throws std::invalid_argument unless low < high are finite and there are 1 to 10^5 bins.
  explicit histogram(const equal_bins& bins) : bins_(bins), per_width_(1.0 / bins.width()) {
    constexpr int most = 100'000;  // one histogram a lane and a group of trajectories must fit into memory
    const bool sound = bins.low < bins.high && std::isfinite(per_width_) && per_width_ > 0.0;
    if (!sound || bins.count < 1 || bins.count > most) {
      throw std::invalid_argument(
          fmt::format("histogram: {} bins from {} to {}: cannot be, take 1 to {} bins "
                      "between finite numbers that rise",
                      bins.count, bins.low, bins.high, most));
    }
    counts_.resize(static_cast<std::size_t>(bins.count) + 2);
  }

  /// That of which counts() are known. Throws std::invalid_argument also if they are of other bins.
  histogram(const equal_bins& bins, std::span<const std::int64_t> counts) : histogram(bins) {
    if (counts.size() != counts_.size()) {
      throw std::invalid_argument(fmt::format(
          "histogram: {} counts are not those of {} bins, below and above", counts.size(), bins.count));
    }
    counts_.assign(counts.begin(), counts.end());
  }

  /// Counts x; infinities lie below and above. Throws std::invalid_argument if x is NaN.
  void add(double x) {
    if (std::isnan(x)) throw std::invalid_argument("histogram: NaN lies in no bin");
    count(place(x));
  }
  /// Adds what the other counted. Throws std::invalid_argument if the bins differ.
  histogram& operator+=(const histogram& other) {
    require_bins_of(other);
    for (std::size_t i = 0; i < counts_.size(); ++i) counts_[i] += other.counts_[i];
    return *this;
  }
  /// Takes away what was added. Throws std::invalid_argument if the bins differ.
  histogram& operator-=(const histogram& other) {
    require_bins_of(other);
    for (std::size_t i = 0; i < counts_.size(); ++i) counts_[i] -= other.counts_[i];
    return *this;
  }

  const equal_bins& bins() const { return bins_; }  ///< where numbers are counted
  /// How many lie below, in each of the bins from low to high, and above.
  std::span<const std::int64_t> counts() const { return counts_; }
  /// How many numbers were added.
  std::int64_t total() const { return std::accumulate(counts_.begin(), counts_.end(), std::int64_t{0}); }

  /// The counts over total(), in the same order. Throws std::invalid_argument if nothing was added.
  std::vector<double> fractions() const {
    const auto all = static_cast<double>(total());
    if (all == 0.0) throw std::invalid_argument("histogram: nothing was added, so it has no fractions");
    std::vector<double> result;
    for (const std::int64_t n : counts_) result.push_back(static_cast<double>(n) / all);
    return result;
  }
  /// Fraction per width of the bins from low to high. Throws like fractions().
  std::vector<double> density() const {
    const auto all = fractions();
    std::vector<double> result(all.begin() + 1, all.end() - 1);
    for (double& fraction : result) fraction /= bins_.width();
    return result;
  }
  /// Throws std::invalid_argument if the bins differ.
  void require_bins_of(const histogram& other) const {
    if (bins_ == other.bins_) return;
    throw std::invalid_argument(fmt::format(
        "histograms of {} bins from {} to {} and of {} from {} to {} cannot be joined or compared",
        bins_.count, bins_.low, bins_.high, other.bins_.count, other.bins_.low, other.bins_.high));
  }

 private:
  template <class T>
  friend class histogram_along;

  /// In [k, k + 1) for bin k, -1 below, and `count` above; NaN is somewhere.
  template <class T>
  T place(const T& x) const {
    const T last(bins_.count - 1.0);
    const T inside = (x - bins_.low) * per_width_;
    const T from_low = select(x < bins_.low, T(-1.0), select(inside < last, inside, last));
    return select(x > bins_.high, T(bins_.count * 1.0), from_low);
  }
  void count(double place) { ++counts_[static_cast<std::size_t>(static_cast<int>(place) + 1)]; }

  equal_bins bins_;
  double per_width_;
  std::vector<std::int64_t> counts_;
};

/// One histogram for each of the trajectories in the lanes of T, so that one of them can be left out.
template <class T>
class histogram_along {
 public:
  /// Empty. Throws like histogram.
  explicit histogram_along(const equal_bins& bins) : in_lanes_(lanes_in<T>, histogram(bins)) {}

  /// One number in each lane.
  void add(const T& x) {
    const T places = in_lanes_.front().place(x);
    for (int k = 0; k < lanes_in<T>; ++k) in_lanes_[static_cast<std::size_t>(k)].count(lane(places, k));
  }
  /// The histogram of lane k. Of a lane that ever was NaN nothing is known but the total.
  const histogram& in_lane(int k) const { return in_lanes_[static_cast<std::size_t>(k)]; }

 private:
  std::vector<histogram> in_lanes_;
};

}  // namespace nysalt
