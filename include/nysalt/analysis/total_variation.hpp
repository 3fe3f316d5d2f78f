// SPDX-License-Identifier: BSL-1.0
// Total variation between two distributions, and its expectation for two samples of one.
#pragma once

#include <span>
#include <vector>

#include "nysalt/analysis/histogram.hpp"
#include "nysalt/analysis/statistics.hpp"

namespace nysalt {

/// 1/2 sum_i |p_i - q_i| over all bins, those below and above too: between 0 and 1.
/// Throws std::invalid_argument if the bins differ or one of the two is empty.
double total_variation(const histogram& a, const histogram& b);

/// The mean distance of one histogram to those of independent ensembles: what compares with sampling_floor
/// of the same ensembles, if all have as many trajectories and samples.
/// Throws std::invalid_argument if there is no ensemble, and like total_variation.
double mean_total_variation(const histogram& given, std::span<const histogram> ensembles);

/// Total variation of ensembles in independent groups of trajectories
/// (gathered_statistics::histogram_of_groups), with its standard error: by the jackknife over the groups of
/// the given one, and over those of each of the others, whose variances add up.
///
/// It estimates how far the number would scatter if all ensembles were drawn again: about its expectation at
/// this many trajectories, which lies above the distance of the distributions. That bias is what
/// sampling_floor measures, and no part of the standard error. Where the distance is well above the floor the
/// error is right. Near the floor, where only chance decides which of p_i and q_i is larger, it is too large,
/// by a factor of sqrt(1/(1 - 2/pi)) = 1.66 for many bins. NaN with fewer than two groups.
///
/// Memory: a histogram. Cost: two passes over all bins for each group of each of the others.
/// Throws std::invalid_argument if there is no ensemble or no group, and like total_variation.
estimate mean_total_variation(std::span<const histogram> groups,
                              std::span<const std::vector<histogram>> ensembles);

/// The mean distance over all pairs of independent ensembles of one distribution: the distance that is due to
/// sampling. With n independent numbers in each, it is about sum_i sqrt(p_i (1 - p_i)/(pi n)).
/// Throws std::invalid_argument unless there are 4 ensembles at least (three have only 3 pairs).
double sampling_floor(std::span<const histogram> ensembles);

}  // namespace nysalt
