// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "nysalt/detail/sentence.hpp"
#include "nysalt/lanes.hpp"
#include "nysalt/noise.hpp"

namespace nysalt {

/// Standard normal numbers of n consecutive intervals become those of all of them in one: with a the decay of
/// one interval, exp(-gamma tau),
///   xi = sqrt((1 - a^2)/(1 - a^{2 n})) sum_{j = 1..n} a^{n - j} xi_j,
/// so that the noise of O is the same exactly, for any sigma [li_lu_tao_ye_2023, equation (3.11), with the
/// exponent that does not reverse time].
class coarse_graining {
 public:
  /// `damping` is gamma tau of one interval.
  explicit coarse_graining(double damping) : damping_(damping), decay_(std::exp(-damping)) {}

  /// Interval by interval: first() clears the sum, next() adds, and last() brings that of n to unit variance.
  template <class T, int N>
  static void first(vector<T, N>& sum) {
    for (T& x : sum) x = T(0.0);
  }
  /// sum <- a sum + xi.
  template <class T, int N>
  void next(vector<T, N>& sum, const auto& xi) const {
    for (Eigen::Index i = 0; i < sum.size(); ++i) sum[i] = sum[i] * decay_ + xi[i];
  }
  /// Scales the sum of n intervals; one or none is left as it is.
  template <class T, int N>
  void last(vector<T, N>& sum, std::int64_t n) const {
    if (n <= 1) return;  // of none, for a letter O that does nothing, there is no noise
    const auto count = static_cast<double>(n);
    const double share =
        damping_ == 0.0 ? 1.0 / count : std::expm1(-2.0 * damping_) / std::expm1(-2.0 * damping_ * count);
    const double scale = std::sqrt(share);
    for (T& x : sum) x = x * scale;
  }

  /// All intervals in one, in their order; 0 if there are none.
  template <class T, int N>
  void over(std::span<const vector<T, N>> intervals, vector<T, N>& xi) const {
    over(intervals, 0, intervals.size(), xi);
  }
  /// Noise over `count` intervals of a list, from one on.
  template <class T, int N>
  void over(const auto& intervals, std::size_t from, std::size_t count, vector<T, N>& xi) const {
    first(xi);
    for (std::size_t k = 0; k < count; ++k) next(xi, intervals[from + k]);
    last(xi, static_cast<std::int64_t>(count));
  }

 private:
  double damping_;
  double decay_;
};

/// The recorded noise of a run: standard normal numbers of consecutive intervals, of one trajectory or of
/// those in the lanes of T.
template <class T, int N>
class recorded_path {
 public:
  /// An empty path, in a bath of that friction. Throws std::invalid_argument unless the interval is positive
  /// and the friction not negative, and finite.
  recorded_path(double interval, double friction, std::uint64_t trajectory = 0)
      : interval_(interval), trajectory_(trajectory), coarse_(friction * interval) {
    if (interval > 0.0 && std::isfinite(interval) && friction >= 0.0 && std::isfinite(friction)) return;
    throw std::invalid_argument(
        sentence("recorded_path: interval must be > 0 and friction >= 0, got {} and {}", interval, friction));
  }

  double interval() const { return interval_; }             ///< length of each in time
  std::uint64_t trajectory() const { return trajectory_; }  ///< trajectory number, of lane 0
  /// Number of the first interval that is held.
  std::int64_t begin() const { return begin_; }
  std::int64_t end() const { return begin_ + std::ssize(normals_); }  ///< number of the one after the last

  void add(vector<T, N> normals) {
    normals_.push_back(std::move(normals));
  }  ///< appends the noise of interval end()
  /// Forgets the intervals before that number: a reader that advances in intervals keeps little of the path.
  void forget_before(std::int64_t interval) {
    const std::int64_t known = std::clamp(interval, begin_, end());
    normals_.erase(normals_.begin(), normals_.begin() + (known - begin_));
    begin_ = known;
  }

  /// The numbers of intervals from .. to - 1 made those of one. Throws std::invalid_argument if they are not
  /// held.
  void over(std::int64_t from, std::int64_t to, vector<T, N>& xi) const {
    if (from < begin_ || to > end()) {
      throw std::invalid_argument(
          sentence("recorded_path: the path must hold the intervals of the run, got {} to {} of length "
                   "{} for {} to {}; record a longer path",
                   begin_, end(), interval_, from, to));
    }
    const auto held = std::span<const vector<T, N>>(normals_);
    coarse_.over(held.subspan(static_cast<std::size_t>(from - begin_), static_cast<std::size_t>(to - from)),
                 xi);
  }

 private:
  double interval_;
  std::uint64_t trajectory_;
  std::int64_t begin_ = 0;
  coarse_graining coarse_;
  std::vector<vector<T, N>> normals_;
};

}  // namespace nysalt
