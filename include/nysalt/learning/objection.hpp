// SPDX-License-Identifier: BSL-1.0
// When a fit is not to be trusted.
#pragma once

#include <string>
#include <vector>

#include "nysalt/learning/fit_summary.hpp"
#include "nysalt/shard.hpp"

namespace nysalt::detail {

/// Standard error of sum_m (a_m - b_m) over independent trajectories m; infinite, as
/// nothing is known, if there is but one.
double noise_of_difference(const std::vector<double>& a, const std::vector<double>& b, const shard& share);

/// The numbers of the trajectories of all ranks. Collective.
std::vector<double> gathered(const std::vector<double>& numbers, const shard& share);

/// The statistic of Wilcoxon's signed-rank test of ln(b_m/a_m) over its standard deviation: normal(0, 1)
/// where a and b are equally good on each trajectory, positive where a is better [wilcoxon_1945]. Ties have
/// their mean rank, and equal losses do not count.
double signed_rank(const std::vector<double>& a, const std::vector<double>& b, const shard& share);

/// Whether a errs less than b on trajectories m that both share: the sum is smaller by more than rounding
/// (below 1e-24 errors are 1e-12 of an increment), and the difference of means or the signed ranks of the
/// ratios show it. So neither a few trajectories that decide a mean hide what is true of most, nor the many
/// hide what a few lose. Two standard errors of one criterion are a false alarm of 2.3 %; each of two
/// criteria may have half of that, which is 2.28 standard deviations (Bonferroni).
bool is_better(const std::vector<double>& a, const std::vector<double>& b, const shard& share);

/// Why a fit should not be used; empty if it may be. Settled: it converged, or is held by the guard.
std::string objection(const fit_summary& fit, bool settled, const std::string& instability);

}  // namespace nysalt::detail
