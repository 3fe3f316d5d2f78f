// SPDX-License-Identifier: BSL-1.0
// Statistics of samples: means, quantiles, tails, histograms, autocovariances.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <numeric>
#include <span>
#include <stdexcept>
#include <type_traits>
#include <vector>

#include "nysalt/core/sentence.hpp"
#include "nysalt/core/tree_sum.hpp"
#include "nysalt/lanes.hpp"

namespace nysalt {

/// A mean over independent trajectories and its standard error. NaN where there are too few.
struct estimate {
  double mean = std::numeric_limits<double>::quiet_NaN();            ///< mean over trajectories
  double standard_error = std::numeric_limits<double>::quiet_NaN();  ///< standard error of the mean
};

/// Mean and standard error of one sample a trajectory, added up by tree_sum; NaN marks a trajectory that does
/// not count.
estimate mean_and_error(std::span<const double> samples);

/// Mean of a_i - b_i, of the same trajectory i each: what both share of chance cancels. Pairs in which one is
/// NaN do not count.
estimate paired_difference(std::span<const double> a, std::span<const double> b);

/// The middle one, or the mean of the two in the middle; infinities are allowed. NaN if there is none.
double median(std::vector<double> samples);

namespace detail {

/// The numbers that are not NaN, from the smallest on.
std::vector<double> sorted_numbers(std::vector<double> samples);

}  // namespace detail

/// Below which the share p of sorted numbers lies, linear between neighbours. NaN if there is none.
double quantile(std::span<const double> sorted, double p);

namespace detail {

/// The median of n sorted numbers, and half of the distance between those that are sqrt(n)/2 places above and
/// below: as many lie below the median of the distribution as heads fall among n coins, for any distribution.
/// NaN where there are too few.
estimate median_and_error(std::span<const double> sorted);

}  // namespace detail

/// Slope of the least-squares line through (x_i, y_i).
double slope(std::span<const double> x, std::span<const double> y);

// Heavy tails: means over trajectories, and standard errors, that rest on few of them.

/// The upper tail of a sample: of the scores of trajectories, whose mean is an error.
struct tail {
  double count = 0.0;     ///< count of the values that are not NaN
  double skewness = 0.0;  ///< third central moment over the power 3/2 of the second; 0 where all are equal
  double deciding = 0.0;  ///< (sum x)^2/sum x^2: how many equal numbers would scatter as much; at most count

  /// The number of values that is enough for mean +- 1.96 standard errors to miss with a probability of at
  /// most 6 %, where 5 % is meant: 25 skewness^2. A sample that has not met the tail of the distribution
  /// underestimates it. Source: [cochran_1977, section 2.15].
  double enough() const { return 25.0 * skewness * skewness; }
  /// Whether the sample is too small for its own tail: then the mean and its standard error say little, and
  /// quantiles say more.
  bool is_heavy() const { return count < enough(); }
};

/// The tail of numbers, one a trajectory; NaN marks a trajectory that does not count. Sums are taken by
/// tree_sum, so that neither threads nor ranks change a bit.
tail tail_of(std::span<const double> numbers);

// Histogram of a number over equal bins.

/// `count` bins of equal width on [low, high]. A number on an edge belongs to the bin above it, to rounding;
/// `high` itself to the last bin.
struct equal_bins {
  double low;   ///< lower edge of the first bin
  double high;  ///< upper edge of the last bin
  int count;    ///< number of bins

  double width() const { return (high - low) / count; }                    ///< width of a bin
  friend bool operator==(const equal_bins&, const equal_bins&) = default;  ///< equal in all
};

namespace detail {
template <class T>
class histogram_along;
}  // namespace detail

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
  friend class detail::histogram_along;

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

namespace detail {

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

}  // namespace detail

// Total variation between two distributions, and its expectation for two samples of one.

/// 1/2 sum_i |p_i - q_i| over all bins, those below and above too: between 0 and 1.
/// Throws std::invalid_argument if the bins differ or one of the two is empty.
double total_variation(const histogram& a, const histogram& b);

/// The mean distance of one histogram to the histograms of independent ensembles: what compares with
/// sampling_floor of the same ensembles, if all have as many trajectories and samples. Throws
/// std::invalid_argument if there is no ensemble, and like total_variation.
double mean_total_variation(const histogram& given, std::span<const histogram> ensembles);

/// Total variation of ensembles in independent groups of trajectories
/// (gathered_statistics::histogram_of_groups), with its standard error: by the jackknife over the groups of
/// the given one, and over the groups of each of the others, whose variances add up.
///
/// It estimates how far the number would scatter if all ensembles were drawn again: about its expectation at
/// this many trajectories, which lies above the distance of the distributions. That bias is what
/// sampling_floor measures, and no part of the standard error. Where the distance is well above the floor the
/// error is right. Near the floor, where only chance decides which of p_i and q_i is larger, it is too large,
/// by a factor of sqrt(1/(1 - 2/pi)) = 1.66 for many bins. NaN with fewer than two groups.
///
/// Memory: a histogram. Cost: two passes over all bins for each group of each of the others.
/// Throws std::invalid_argument if there is no ensemble or no group, and like total_variation.
estimate mean_total_variation(std::span<const histogram> groups,
                              std::span<const std::vector<histogram>> ensembles);

/// The mean distance over all pairs of independent ensembles of one distribution: the distance that is due to
/// sampling. With n independent numbers in each, it is about sum_i sqrt(p_i (1 - p_i)/(pi n)).
/// Throws std::invalid_argument unless there are 4 ensembles at least (three have only 3 pairs).
double sampling_floor(std::span<const histogram> ensembles);

// Weights of the samples of a trajectory in a mean over time.

namespace detail {

/// Weights of samples at t_i = i h, i = 0 .. n: all from the first on alike, or the weights of the mean over
/// [0, T] by the trapezoidal rule, T within the last step: what is sampled is linear between two samples, and
/// its part up to T counts. Then methods of other steps have means over the very same interval of time. For
/// what grows like t^k the rule errs by about k (k + 1)/12 of n^-2: by 0.5 % for k = 2 and ten samples.
class sample_weights {
 public:
  /// Equal weights of `samples` samples.
  explicit sample_weights(std::int64_t samples) : samples_(samples) {}

  /// Weights of the mean over [0, horizon]. Throws std::invalid_argument unless it ends within the last step.
  sample_weights(double step, std::int64_t samples, double horizon);

  /// Weight of sample i.
  double operator()(std::int64_t i) const {
    if (is_alike_) return i == 0 ? 0.0 : 1.0;
    double weight = 0.0;
    if (i > 0) weight += covered(i) * covered(i) / 2.0;
    if (i < samples_) weight += covered(i + 1) * (1.0 - covered(i + 1) / 2.0);
    return weight;
  }

  /// Their sum.
  double total() const { return static_cast<double>(samples_) - (is_alike_ ? 0.0 : 1.0 - last_); }

 private:
  /// Share of the step before sample i that counts.
  double covered(std::int64_t i) const { return i == samples_ ? last_ : 1.0; }

  std::int64_t samples_;
  bool is_alike_ = true;
  double last_ = 1.0;
};

}  // namespace detail

// Integrated autocorrelation time: the number of samples that count for one.

/// Integrated autocorrelation time in units of the interval between samples.
struct integrated_time {
  double tau = 1.0;        ///< 1 + 2 sum_{k=1..W} rho(k): that number of samples counts for one in a mean
  double memory = 1.0;     ///< 1 + 2 sum_{k=1..W} |rho(k)|: how long an oscillating observable remembers
  std::size_t window = 0;  ///< W
  bool enough = false;     ///< false: the lags end before the window does, or noise outweighs tau
};

/// Integrated autocorrelation time from rho(0..L), rho(0) = 1, with Sokal's self-consistent window
/// [sokal_1997]: the smallest W >= 5 memory(W) (10 of his times, which are half of ours; the rest of an
/// exponential is then below 1e-4). The window asks memory, which for rho >= 0 is tau: tau itself dips where
/// rho oscillates, and the window would close there. Without enough lags tau and memory are what all of them
/// add up to. A burn-in follows from memory. Throws std::invalid_argument if there is no lag.
integrated_time integrated_autocorrelation_time(std::span<const double> rho);

/// The independent samples that would give a mean the error of `samples` samples along a trajectory,
/// samples/tau; NaN where the lags were not enough. Of tau measured on these samples the standard error is
/// about tau sqrt((4 W + 2)/samples) [sokal_1997]. tau counts as two such errors at least, with memory in
/// place of tau: an estimate that noise makes too small would make the error of the mean too small.
double effective_sample_size(double samples, const integrated_time& time);

// The sums along a trajectory from which an autocovariance is computed.

namespace detail {

/// Sums of some trajectories at one lag k over all pairs of samples y_t, y_{t+k} of one trajectory: their
/// number, and the sums of y_t y_{t+k}, of y_t and of y_{t+k}, where y is the observable less a centre.
struct pair_sums {
  double pairs = 0.0;     ///< number of pairs
  double products = 0.0;  ///< sum of y_t y_{t+k}
  double heads = 0.0;     ///< sum of y_t
  double tails = 0.0;     ///< sum of y_{t+k}

  /// C = mean y_t y_{t+k} - mean y_t mean y_{t+k}; NaN if there is no pair.
  double covariance() const { return products / pairs - (heads / pairs) * (tails / pairs); }

  /// Sums over the pairs of both.
  friend pair_sums operator+(const pair_sums& a, const pair_sums& b) {
    return {a.pairs + b.pairs, a.products + b.products, a.heads + b.heads, a.tails + b.tails};
  }
  /// Sums over the pairs of a that are not pairs of b.
  friend pair_sums operator-(const pair_sums& a, const pair_sums& b) {
    return {a.pairs - b.pairs, a.products - b.products, a.heads - b.heads, a.tails - b.tails};
  }
};

/// Sums of pairs at the lags 0..L.
using autocovariance_sums = std::vector<pair_sums>;

/// The number of lags. Throws std::invalid_argument unless it is 1 to 10^5: a sample costs a product a lag.
std::size_t checked_lags(int lags);

/// Takes the samples of the trajectories in the lanes of T one by one, each sum in the order of time: the
/// bits do not depend on the lanes. The heads of lag k are all samples but the last k, the tails all but the
/// first k. Memory: 3 L + 8 samples of T. Cost of a sample: L + 1 products.
template <class T>
class autocovariance_along {
 public:
  /// A centre near the mean keeps the digits: sums of (y + c)^2 lose the digits of c^2/variance. Throws
  /// std::invalid_argument if the lags cannot be or the centre is not finite.
  autocovariance_along(int lags, double centre) : centre_(centre), lags_(checked_lags(lags)) {
    if (!std::isfinite(centre)) {
      throw std::invalid_argument(sentence("autocovariance: the centre must be finite, got {}", centre));
    }
    window_.assign(lags_ + samples_at_a_time,
                   T(0.0));  // zeros before the first sample make no pairs and add nothing
    first_.reserve(lags_);
    products_.assign(lags_ + 1, T(0.0));
  }

  /// The next sample, one number a lane.
  void add(const T& x) {
    const T y = x - centre_;
    if (first_.size() < lags_) first_.push_back(y);
    total_ += y;
    window_[lags_ + waiting_] = y;
    samples_ += 1.0;
    if (++waiting_ == samples_at_a_time)
      add_waiting(std::integral_constant<std::size_t, samples_at_a_time>());
  }

  /// The sums of lane k. Throws std::invalid_argument unless there are more samples than lags.
  autocovariance_sums in_lane(int k) {
    if (!(samples_ > static_cast<double>(lags_))) {
      throw std::invalid_argument(
          sentence("autocovariance: the number of samples along a trajectory must exceed the {} lags, "
                   "got {}",
                   lags_, samples_));
    }
    add_waiting(waiting_);
    autocovariance_sums result(lags_ + 1);
    double head = lane(total_, k);
    double tail = head;
    for (std::size_t lag = 0; lag <= lags_; ++lag) {
      if (lag > 0) head -= lane(window_[lags_ - lag], k);
      if (lag > 0) tail -= lane(first_[lag - 1], k);
      result[lag] = {samples_ - static_cast<double>(lag), lane(products_[lag], k), head, tail};
    }
    return result;
  }

 private:
  static constexpr std::size_t samples_at_a_time =
      8;  // samples at a time, so that a lag's sum stays in its register

  template <class Count>
  void add_waiting(Count count) {
    const T* const now = window_.data() + lags_;
    for (std::size_t lag = 0; lag <= lags_; ++lag) {
      T sum = products_[lag];
      for (std::size_t i = 0; i < count; ++i) sum += now[i] * (now - lag)[i];
      products_[lag] = sum;
    }
    const auto first = window_.begin() + static_cast<std::ptrdiff_t>(std::size_t{count});
    std::copy(first, first + static_cast<std::ptrdiff_t>(lags_), window_.begin());
    waiting_ = 0;
  }

  double centre_;
  std::size_t lags_;
  std::size_t waiting_ = 0;
  double samples_ = 0.0;
  T total_{0.0};
  std::vector<T> window_;  // the last samples: `lags` of old, and those that wait
  std::vector<T> first_;   // the first `lags` samples
  std::vector<T> products_;
};

}  // namespace detail

// Autocovariance of an observable, with error bars.

/// The autocovariance of an observable x in a stationary state at the lags k = 0..L,
///   C(k) = mean x_t x_{t+k} - mean x_t mean x_{t+k},
/// means over all trajectories and times t [li_lu_tao_ye_2023, eq:ACF]; rho(k) = C(k)/C(0).
///
/// Standard errors hold for independent trajectories: the jackknife over groups of them, which leaves out
/// one group after the other; from G groups a standard error is itself known to 1/sqrt(2 (G - 1)) of it.
class autocovariance {
 public:
  /// A distance of two autocovariances with a standard error.
  struct distance {
    double rms;             ///< root mean square difference over the lags 1..L
    double standard_error;  ///< standard error of rms
    double floor;           ///< expected rms of sampling error only
  };

  /// Autocovariance with one term a group of independent trajectories, all with one centre; `interval` is the
  /// time between samples. Groups without a trajectory do not count. Throws std::invalid_argument if there is
  /// no group or their lags differ.
  autocovariance(double interval, double centre, std::vector<detail::autocovariance_sums> groups);

  std::size_t lags() const { return total_.size() - 1; }  ///< L, the largest lag
  double interval() const { return interval_; }           ///< time between samples, which is one lag
  /// Number of groups that count.
  std::size_t groups() const { return groups_.size(); }
  /// Mean of the observable; NaN if no trajectory counts.
  double mean() const { return centre_ + total_[0].heads / total_[0].pairs; }
  /// C(k); NaN if no trajectory counts.
  double covariance(std::size_t k) const { return total_.at(k).covariance(); }
  /// rho(0..L). Throws std::runtime_error if the observable did not vary, or no trajectory counts.
  std::vector<double> normalised() const { return normalised(total_); }
  /// Standard errors of rho(0..L); NaN if there are fewer than two groups. Throws like normalised().
  std::vector<double> standard_error() const;

  /// The variances of the numbers f(rho), by the jackknife: (G - 1)/G sum_g (f_g - mean f)^2, where f_g lacks
  /// group g. NaN if there are fewer than two groups. Throws like normalised().
  std::vector<double> jackknife(
      const std::function<std::vector<double>(const std::vector<double>&)>& f) const;

 private:
  static std::vector<double> normalised(const detail::autocovariance_sums& sums);

  double interval_;
  double centre_;
  detail::autocovariance_sums total_;
  std::vector<detail::autocovariance_sums> groups_;
};

// The distance between two autocovariances.

/// rms = sqrt(1/L sum_{k=1..L} (rho_a(k) - rho_b(k))^2) of the normalised autocovariances, with the standard
/// error of independent ensembles; floor^2 = 1/L sum_k (error_a(k)^2 + error_b(k)^2), the mean of rms^2 if
/// both have one distribution. If a and b share starts or noise, error and floor are larger than needed.
/// Throws std::invalid_argument if lags or intervals (to 1e-9 relative, as steps are typed in decimals)
/// differ, and like autocovariance::normalised.
autocovariance::distance acf_error(const autocovariance& a, const autocovariance& b);

}  // namespace nysalt
