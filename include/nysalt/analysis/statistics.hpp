// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "nysalt/detail/tree_sum.hpp"

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

/// The numbers that are not NaN, from the smallest on.
std::vector<double> sorted_numbers(std::vector<double> samples);

/// Below which the share p of sorted numbers lies, linear between neighbours. NaN if there is none.
double quantile(std::span<const double> sorted, double p);

/// The median of n sorted numbers, and half of the distance between those that are sqrt(n)/2 places above and
/// below: as many lie below the median of the distribution as heads fall among n coins, for any distribution.
/// NaN where there are too few.
estimate median_and_error(std::span<const double> sorted);

/// Slope of the least-squares line through (x_i, y_i).
double slope(std::span<const double> x, std::span<const double> y);

}  // namespace nysalt
