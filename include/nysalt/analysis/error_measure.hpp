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
#include "nysalt/phase_point.hpp"

namespace nysalt {

/// How errors e of samples become one number. Means over times come first, those over trajectories last:
///   mean           mean of e
///   root_of_each   mean over trajectories of sqrt(mean over times of e)
///   root_of_all    sqrt(mean over trajectories and times of e)
enum class averaging { mean, root_of_each, root_of_all };

/// A measure reads a few numbers of a state and compares those of a method with those of a reference at the
/// same time. It is a value that is chosen at run time; models are in analysis/error_measures/. Its functions
/// may be called from several threads at once.
template <int N>
struct error_measure {
  using numbers = std::span<const double>;

  std::string name;
  std::size_t width;  // numbers that are read of a state
  std::function<void(const phase_point<double, N>& x, std::span<double> result)> read;
  /// The error of one sample. `expected` is empty if no reference is needed. May throw std::invalid_argument
  /// where there is no such error.
  std::function<double(numbers seen, numbers expected, numbers at_start)> error;
  averaging how;
  bool needs_reference = true;

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

  std::vector<double> numbers_of(const phase_point<double, N>& x) const {
    std::vector<double> result(width);
    read(x, result);
    return result;
  }
};

}  // namespace nysalt
