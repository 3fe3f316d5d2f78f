// SPDX-License-Identifier: BSL-1.0
// The noise of a path that is recorded, for steps of any length.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <type_traits>
#include <utility>
#include <vector>

#include "nysalt/core/sentence.hpp"
#include "nysalt/lanes.hpp"
#include "nysalt/noise.hpp"

namespace nysalt {

namespace detail {

/// Standard normal numbers of n consecutive intervals become the numbers of all of them in one: with a the
/// decay of one interval, exp(-gamma tau),
///   xi = sqrt((1 - a^2)/(1 - a^{2 n})) sum_{j = 1..n} a^{n - j} xi_j,
/// so that the noise of O is the same exactly, for any sigma [li_lu_tao_ye_2023, equation (3.11), with the
/// exponent that does not reverse time].
class coarse_graining {
 public:
  /// `damping` is gamma tau of one interval.
  explicit coarse_graining(double damping) : damping_(damping), decay_(std::exp(-damping)) {}

  /// Interval by interval: first() clears the sum, next() adds, and last() brings the sum of n to unit
  /// variance.
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

}  // namespace detail

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

  /// The numbers of intervals from .. to - 1 made the numbers of one. Throws std::invalid_argument if they
  /// are not held.
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
  detail::coarse_graining coarse_;
  std::vector<vector<T, N>> normals_;
};

/// The noise of a recorded path for the letters O of a method: each letter O has the noise of its own part of
/// the step, halves included. Refers to the path.
template <class T, int N>
class along_path {
 public:
  static constexpr bool is_memoryless = false;

  /// A path for a word whose letters O cover `intervals` of a step. Throws std::invalid_argument unless the
  /// parts of a step are whole intervals of the path.
  along_path(const recorded_path<T, N>& path, detail::noise_intervals intervals, double step)
      : path_(&path), intervals_(std::move(intervals)) {
    if (intervals_.parts == 0) return;
    const double part = step / intervals_.parts / path.interval();
    per_part_ = std::llround(part);
    if (per_part_ >= 1 && std::abs(part - static_cast<double>(per_part_)) <= 1e-9 * part) return;
    throw std::invalid_argument(
        sentence("along_path: the step {} in the {} parts of the letters O must consist of whole "
                 "intervals {} of the recorded path",
                 step, intervals_.parts, path.interval()));
  }

  /// The noise of the path over one letter O of one step. Throws std::invalid_argument where the path is too
  /// short, or is another trajectory's.
  template <class U>
  void normals(const noise_place& at, vector<U, N>& xi) const {
    const auto [begin, end] = intervals_.of_letters[static_cast<std::size_t>(at.flow)];
    const std::int64_t first = at.step * intervals_.parts;
    const std::int64_t from = (first + begin) * per_part_;
    const std::int64_t to = (first + end) * per_part_;
    constexpr bool all_lanes = std::is_same_v<U, T>;
    static_assert(all_lanes || std::is_same_v<U, double>, "nysalt: a path is for all its lanes or one");
    const std::uint64_t lane_of = at.trajectory - path_->trajectory();
    if (lane_of >= (all_lanes ? 1 : lanes_in<T>)) {
      throw std::invalid_argument(
          sentence("along_path: the recorded path must be that of the trajectory, got trajectory {}, "
                   "not of {}",
                   path_->trajectory(), at.trajectory));
    }
    if constexpr (all_lanes) {
      path_->over(from, to, xi);
    } else {  // one lane of several
      vector<T, N> all(xi.size());
      path_->over(from, to, all);
      for (Eigen::Index i = 0; i < xi.size(); ++i) xi[i] = lane(all[i], static_cast<int>(lane_of));
    }
  }

 private:
  const recorded_path<T, N>* path_;
  detail::noise_intervals intervals_;
  std::int64_t per_part_ = 0;
};

}  // namespace nysalt
