// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <span>

namespace nysalt::detail {

/// The jackknife estimate of the variance of a statistic of G independent groups,
/// (G - 1)/G sum_g (d_g - mean d)^2, where d_g is the statistic without group g. NaN if G < 2. Squares are
/// taken about `all`, the statistic of all groups, so that rounding stays small beside the differences.
double jackknife_variance(std::span<const double> without, double all);

}  // namespace nysalt::detail
