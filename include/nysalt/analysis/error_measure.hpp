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
  /// What `error` divides by, sample by sample. Where that is 0 there is no error, and where its sign is not
  /// the same everywhere its mean does not exist: `no_scale` says so. Not given: nothing.
  std::function<T(numbers reference)> scale = {};
  std::string no_scale = {};  ///< the sentence that is thrown where there is no scale
  /// What errors are relative to, >= 0 and in the units of `error`: the mean error is divided by the mean of
  /// this over all trajectories and times, which is a property of their law, and positive unless all is 0
  /// (`no_scale` then). Not given: absolute.
  std::function<T(numbers reference)> relative_to = {};

  /// What a trajectory contributes whose errors, weighted by time, add up to `sum`.
  double score(double sum, double weights) const {
    const double mean = sum / weights;
    return how == averaging::root_of_each ? std::sqrt(mean) : mean;
  }

  /// What errors are divided by: 1, or the mean of `sizes`, the means over time of what they are relative to,
  /// one a trajectory; its root where errors are of squares. Without sizes errors are absolute.
  double unit(std::span<const double> sizes) const {
    if (!relative_to || sizes.empty()) return 1.0;
    const double mean = mean_and_error(sizes).mean;
    return how == averaging::mean ? mean : std::sqrt(mean);
  }

  /// The error over all trajectories and its standard error, from their scores (NaN: does not count) and
  /// sizes, of which there may be more. A root has the standard error of the mean below it times 1/(2 root),
  /// a ratio that of its parts: the delta method.
  estimate average(std::span<const double> scores, std::span<const double> sizes = {}) const {
    const estimate mean = mean_and_error(scores);
    const double root = how == averaging::root_of_all ? std::sqrt(mean.mean) : mean.mean;
    if (relative_to && !sizes.empty())
      return {root / unit(sizes), mean_and_error(parts(scores, sizes)).standard_error};
    if (how != averaging::root_of_all || mean.mean == 0.0) return mean;
    return {root, mean.standard_error / (2.0 * root)};
  }

  /// What each trajectory has in that error: numbers of which it is the mean, and whose scatter makes its
  /// standard error (linearised about the mean where it is a root or a ratio). On the same trajectories two
  /// methods differ by the mean of the differences of theirs.
  std::vector<double> parts(std::span<const double> scores, std::span<const double> sizes = {}) const {
    std::vector<double> result(scores.begin(), scores.end());
    const double mean = mean_and_error(scores).mean;
    const bool is_root = how == averaging::root_of_all && mean != 0.0;
    const double root = is_root ? std::sqrt(mean) : mean;
    if (is_root) {
      for (double& x : result) x = root + (x - mean) / (2.0 * root);
    }
    if (!relative_to || sizes.empty()) return result;
    const double its_unit = unit(sizes);
    const double power = how == averaging::mean ? 1.0 : 0.5;
    const double slope = power * root / mean_and_error(sizes).mean;
    double seen = 0.0;  // the mean size of those that count
    double count = 0.0;
    for (std::size_t i = 0; i < scores.size(); ++i) {
      if (std::isnan(scores[i])) continue;
      seen += sizes[i];
      count += 1.0;
    }
    seen /= count;
    for (std::size_t i = 0; i < result.size(); ++i) {
      result[i] = (result[i] - slope * (sizes[i] - seen)) / its_unit;
    }
    return result;
  }

  /// The error of each trajectory by itself, in the unit of the whole: of these there are quantiles.
  std::vector<double> of_each(std::span<const double> scores, std::span<const double> sizes = {}) const {
    std::vector<double> result(scores.begin(), scores.end());
    const double its_unit = unit(sizes);
    for (double& x : result) x = (how == averaging::root_of_all ? std::sqrt(x) : x) / its_unit;
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
