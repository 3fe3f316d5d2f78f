// SPDX-License-Identifier: BSL-1.0
// Measures of the error of a trajectory.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "nysalt/analysis/statistics.hpp"
#include "nysalt/detail/over_scalars.hpp"

namespace nysalt {

/// Averaging of errors e of samples to one number. Means over times come first, those over trajectories last:
///   mean           mean of e
///   root_of_each   mean over trajectories of sqrt(mean over times of e)
///   root_of_all    sqrt(mean over trajectories and times of e)
enum class averaging { mean, root_of_each, root_of_all };

/// A measure reads a few numbers of a state and compares those of a method with those of a reference: the
/// exact state at the same time, or that at the start. It is a value that is chosen at run time; models are
/// in analysis/error_measures/. Its functions take one trajectory, over double, and trajectories side by
/// side, over packs: lambdas of `auto` do. They may be called from several threads at once, and with lanes
/// that hold no sound trajectory.
struct error_measure {
  std::string name;   ///< name in reports
  std::size_t width;  ///< numbers that are read of a state
  /// read(x, result) writes the `width` numbers of a state to a span.
  detail::over_scalars<detail::reads_numbers> read;
  /// error(seen, reference): the error of one sample, from spans of the numbers.
  detail::over_scalars<detail::of_two_samples> error;
  averaging how;                ///< makes one number of all errors
  bool needs_reference = true;  ///< false: the reference is the start
  /// The divisor of `error`, sample by sample, from the numbers of the reference. Where that is 0 there is
  /// no error, and where its sign is not the same everywhere its mean does not exist: `no_scale` says so. Not
  /// given: nothing.
  detail::over_scalars<detail::of_sample> scale = {};
  std::string no_scale = {};  ///< the sentence that is thrown where there is no scale
  /// The scale that errors are relative to, >= 0 and in the units of `error`, from the numbers of the
  /// reference: the mean error is divided by the mean of this over all trajectories and times, which is a
  /// property of their distribution, and positive unless all is 0 (`no_scale` then). Not given: absolute.
  detail::over_scalars<detail::of_sample> relative_to = {};
  Eigen::Index dimension = 0;  ///< degrees of freedom of the measured systems; 0: any number

  /// The contribution of a trajectory whose errors, weighted by time, add up to `sum`.
  double score(double sum, double weights) const;
  /// The divisor of errors: 1, or the mean of `sizes`, the means over time of what they are relative to,
  /// one a trajectory; its root where errors are of squares. Without sizes errors are absolute.
  double unit(std::span<const double> sizes) const;
  /// The error over all trajectories and its standard error, from their scores (NaN: does not count) and
  /// sizes, of which there may be more. A root has the standard error of the mean below it times 1/(2 root),
  /// a ratio that of its parts: the delta method.
  estimate average(std::span<const double> scores, std::span<const double> sizes = {}) const;
  /// The part of each trajectory in that error: numbers of which it is the mean, and whose scatter makes its
  /// standard error (linearised about the mean where it is a root or a ratio). On the same trajectories two
  /// methods differ by the mean of the differences of theirs.
  std::vector<double> parts(std::span<const double> scores, std::span<const double> sizes = {}) const;
  /// The error of each trajectory by itself, in the unit of the whole: of these there are quantiles.
  std::vector<double> of_each(std::span<const double> scores, std::span<const double> sizes = {}) const;

  /// The values that read() writes of a state.
  template <class T, int N>
  std::vector<T> numbers_of(const phase_point<T, N>& x) const {
    std::vector<T> result(width);
    read(phase_point<T, Eigen::Dynamic>{x.q, x.p}, std::span<T>(result));
    return result;
  }
};

}  // namespace nysalt
