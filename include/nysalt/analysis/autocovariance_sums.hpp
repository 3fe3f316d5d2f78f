// SPDX-License-Identifier: BSL-1.0
// The sums along a trajectory from which an autocovariance is computed.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <type_traits>
#include <vector>

#include "nysalt/detail/sentence.hpp"
#include "nysalt/lanes.hpp"

namespace nysalt {

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
  /// Sums over the pairs of a that are not those of b.
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
  /// A centre near the mean keeps the digits: sums of (y + c)^2 lose those of c^2/variance. Throws
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

}  // namespace nysalt
