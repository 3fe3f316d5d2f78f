// SPDX-License-Identifier: BSL-1.0
// Histogram of a number over equal bins.
#pragma once

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "nysalt/lanes.hpp"

namespace nysalt {

/// `count` bins of equal width on [low, high]. A number on an edge belongs to the bin above it, to rounding;
/// `high` itself to the last bin.
struct equal_bins {
  double low;   ///< lower edge of the first bin
  double high;  ///< upper edge of the last bin
  int count;    ///< number of bins

  double width() const { return (high - low) / count; }                    ///< width of a bin
  friend bool operator==(const equal_bins&, const equal_bins&) = default;  ///< equal in all
};

/// Counts in equal bins, and in two further ones for what lies below and above. They are integers: the order
/// of adding, lanes and threads change nothing.
class histogram {
 public:
  /// Empty. Throws std::invalid_argument unless low < high are finite and there are 1 to 10^5 bins.
  explicit histogram(const equal_bins& bins);

  /// A histogram with known counts(). Throws std::invalid_argument also if they are of other bins.
  histogram(const equal_bins& bins, std::span<const std::int64_t> counts);

  /// Counts x; infinities lie below and above. Throws std::invalid_argument if x is NaN.
  void add(double x);
  /// Adds what the other counted. Throws std::invalid_argument if the bins differ.
  histogram& operator+=(const histogram& other);
  /// Takes away what was added. Throws std::invalid_argument if the bins differ.
  histogram& operator-=(const histogram& other);

  const equal_bins& bins() const { return bins_; }  ///< bins of the counts
  /// Numbers of values below, in each of the bins from low to high, and above.
  std::span<const std::int64_t> counts() const { return counts_; }
  /// Number of values that were added.
  std::int64_t total() const { return std::accumulate(counts_.begin(), counts_.end(), std::int64_t{0}); }

  /// The counts over total(), in the same order. Throws std::invalid_argument if nothing was added.
  std::vector<double> fractions() const;
  /// Fraction per width of the bins from low to high. Throws like fractions().
  std::vector<double> density() const;
  /// Throws std::invalid_argument if the bins differ.
  void require_bins_of(const histogram& other) const;

 private:
  template <class T>
  friend class histogram_along;

  /// Position in units of bins: in [k, k + 1) for bin k, -1 below, and `count` above; NaN is somewhere.
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

/// Histograms, one for each of the trajectories in the lanes of T, so that single trajectories can be left
/// out.
template <class T>
class histogram_along {
 public:
  /// Empty. Throws like histogram.
  explicit histogram_along(const equal_bins& bins) : in_lanes_(lanes_in<T>, histogram(bins)) {}

  /// Counts one number in each lane.
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
