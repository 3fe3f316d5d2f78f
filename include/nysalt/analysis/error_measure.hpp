// SPDX-License-Identifier: BSL-1.0
// What "how far off is a trajectory" may mean.
#pragma once

#include <cmath>
#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "nysalt/analysis/statistics.hpp"
#include "nysalt/lanes.hpp"

namespace nysalt {

/// How errors e of samples become one number. Means over times come first, those over trajectories last:
///   mean           mean of e
///   root_of_each   mean over trajectories of sqrt(mean over times of e)
///   root_of_all    sqrt(mean over trajectories and times of e)
enum class averaging { mean, root_of_each, root_of_all };

/// A measure reads a few numbers of a state and compares those of a method with those of a reference: the
/// exact state at the same time, or that at the start. It is a value that is chosen at run time; models are
/// in analysis/error_measures/. It takes W trajectories at a time. Its functions may be called from several
/// threads at once, and with lanes that hold no sound trajectory.
template <int N, int W = default_lanes>
struct error_measure {
  static constexpr int lanes = W;      ///< trajectories at a time
  using T = scalar_of_lanes<W>;        ///< double, or a pack of W
  using numbers = std::span<const T>;  ///< those of one state, `width` of them

  std::string name;   ///< as reports call it
  std::size_t width;  ///< numbers that are read of a state
  /// Writes the `width` numbers of a state.
  std::function<void(const phase_point<T, N>& x, std::span<T> result)> read;
  /// The error of one sample.
  std::function<T(numbers seen, numbers reference)> error;
  averaging how;                ///< makes one number of all errors
  bool needs_reference = true;  ///< false: the reference is the start
  /// What the error is relative to; where that is 0 there is none, which `no_scale` says. Not given:
  /// absolute.
  std::function<T(numbers reference)> scale = {};
  std::string no_scale = {};  ///< the sentence that is thrown where the scale is 0

  /// What a trajectory contributes whose `samples` errors add up to `sum`.
  double score(double sum, double samples) const {
    const double mean = sum / samples;
    return how == averaging::root_of_each ? std::sqrt(mean) : mean;
  }

  /// The error over all trajectories and its standard error, from their scores (NaN: does not count).
  /// A root has the standard error of the mean below it times 1/(2 root): the delta method.
  estimate average(std::span<const double> scores) const {
    const estimate mean = mean_and_error(scores);
    if (how != averaging::root_of_all || mean.mean == 0.0) return mean;
    const double root = std::sqrt(mean.mean);
    return {root, mean.standard_error / (2.0 * root)};
  }

  /// What each trajectory has in that error: numbers of which it is the mean, and whose scatter makes its
  /// standard error (linearised about the mean where it is a root). On the same trajectories two methods
  /// differ by the mean of the differences of theirs.
  std::vector<double> parts(std::span<const double> scores) const {
    std::vector<double> result(scores.begin(), scores.end());
    const double mean = mean_and_error(scores).mean;
    if (how != averaging::root_of_all || mean == 0.0) return result;
    const double root = std::sqrt(mean);
    for (double& x : result) x = root + (x - mean) / (2.0 * root);
    return result;
  }

  /// What read() writes of a state.
  std::vector<T> numbers_of(const phase_point<T, N>& x) const {
    std::vector<T> result(width);
    read(x, result);
    return result;
  }
};

}  // namespace nysalt
