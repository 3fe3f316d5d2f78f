// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <cmath>
#include <cstdint>
#include <type_traits>
#include <utility>
#include <vector>

#include "nysalt/detail/noise_intervals.hpp"
#include "nysalt/detail/sentence.hpp"
#include "nysalt/noises/recorded_path.hpp"

namespace nysalt {

/// The noise of a recorded path for the letters O of a method: that of each letter O over its own part of the
/// step, halves included. Refers to the path.
template <class T, int N>
class along_path {
 public:
  static constexpr bool is_memoryless = false;

  /// A path for a word whose letters O cover `intervals` of a step. Throws std::invalid_argument unless the
  /// parts of a step are whole intervals of the path.
  along_path(const recorded_path<T, N>& path, noise_intervals intervals, double step)
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
  noise_intervals intervals_;
  std::int64_t per_part_ = 0;
};

}  // namespace nysalt
