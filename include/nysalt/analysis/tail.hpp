// SPDX-License-Identifier: BSL-1.0
// Heavy tails: means over trajectories, and standard errors, that rest on few of them.
#pragma once

#include <span>

#include "nysalt/analysis/statistics.hpp"

namespace nysalt {

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

/// The tail of numbers, one a trajectory; NaN marks a trajectory that does not count. Sums are those of
/// tree_sum, so that neither threads nor ranks change a bit.
tail tail_of(std::span<const double> numbers);

}  // namespace nysalt
