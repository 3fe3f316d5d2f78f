// SPDX-License-Identifier: BSL-1.0
// How far apart two distributions are, and how far two samples of one would be.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <span>
#include <stdexcept>
#include <vector>

#include "nysalt/analysis/histogram.hpp"
#include "nysalt/analysis/statistics.hpp"

namespace nysalt {

/// 1/2 sum_i |p_i - q_i| over all bins, those below and above too: between 0 and 1.
/// Throws std::invalid_argument if the bins differ or one of the two is empty.
inline double total_variation(const histogram& a, const histogram& b) {
  a.require_bins_of(b);
  const auto p = a.fractions();
  const auto q = b.fractions();
  double sum = 0.0;
  for (std::size_t i = 0; i < p.size(); ++i) sum += std::abs(p[i] - q[i]);
  return 0.5 * sum;
}

/// The mean distance of one histogram to those of independent ensembles: what compares with sampling_floor
/// of the same ensembles, if all have as many trajectories and samples.
/// Throws std::invalid_argument if there is no ensemble, and like total_variation.
inline double mean_total_variation(const histogram& given, std::span<const histogram> ensembles) {
  if (ensembles.empty())
    throw std::invalid_argument("mean_total_variation: there is nothing to compare with");
  double sum = 0.0;
  for (const histogram& other : ensembles) sum += total_variation(given, other);
  return sum / static_cast<double>(ensembles.size());
}

namespace detail {

inline histogram sum_of(std::span<const histogram> groups) {
  if (groups.empty()) throw std::invalid_argument("total_variation: there is no group of trajectories");
  histogram all(groups.front().bins());
  for (const histogram& group : groups) all += group;
  return all;
}

/// (G - 1)/G sum_g (d_g - mean d)^2, where d_g = distance(all but group g); groups without a trajectory do
/// not count. NaN if there are fewer than two.
template <class Distance>
double jackknife_variance(std::span<const histogram> groups, const histogram& all, const Distance& distance) {
  std::vector<double> without;
  for (const histogram& group : groups) {
    if (group.total() == 0) continue;
    histogram others = all;
    others -= group;
    if (others.total() > 0) without.push_back(distance(others));
  }
  const auto n = static_cast<double>(without.size());
  const double error = mean_and_error(without).standard_error;  // their squares divided by n (n - 1)
  return (n - 1.0) * (n - 1.0) * error * error;
}

}  // namespace detail

/// The same of ensembles in independent groups of trajectories (gathered_statistics::histogram_of_groups),
/// with its standard error: by the jackknife over the groups of the given one, and over those of each of the
/// others, whose variances add up.
///
/// It tells how far the number would scatter if all ensembles were drawn again: about its expectation at this
/// many trajectories, which lies above the distance of the laws. That bias is what sampling_floor measures,
/// and no part of the standard error. Where the distance is well above the floor the error is right. Near the
/// floor, where chance alone decides which of p_i and q_i is larger, it is too large, by a factor of
/// sqrt(1/(1 - 2/pi)) = 1.66 for many bins. NaN with fewer than two groups.
///
/// Memory: a histogram. Cost: two passes over all bins for each group of each of the others.
/// Throws std::invalid_argument if there is no ensemble or no group, and like total_variation.
inline estimate mean_total_variation(std::span<const histogram> groups,
                                     std::span<const std::vector<histogram>> ensembles) {
  const histogram given = detail::sum_of(groups);
  std::vector<histogram> others;
  for (const auto& ensemble : ensembles) others.push_back(detail::sum_of(ensemble));
  const double mean = mean_total_variation(given, others);
  double variance = detail::jackknife_variance(
      groups, given, [&](const histogram& without) { return mean_total_variation(without, others); });
  const auto count = static_cast<double>(others.size());
  for (std::size_t k = 0; k < others.size(); ++k) {
    variance += detail::jackknife_variance(ensembles[k], others[k], [&](const histogram& without) {
      return total_variation(given, without) / count;
    });
  }
  return {mean, std::sqrt(variance)};
}

/// The mean distance over all pairs of independent ensembles of one law: the distance that sampling alone
/// makes. With n independent numbers in each, it is about sum_i sqrt(p_i (1 - p_i)/(pi n)).
/// Throws std::invalid_argument unless there are 4 ensembles at least (three have only 3 pairs).
inline double sampling_floor(std::span<const histogram> ensembles) {
  if (ensembles.size() < 4) {
    throw std::invalid_argument(fmt::format(
        "sampling_floor: {} independent ensembles are too few, take 4 at least (6 pairs)", ensembles.size()));
  }
  double sum = 0.0;
  double pairs = 0.0;
  for (std::size_t i = 0; i < ensembles.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      sum += total_variation(ensembles[i], ensembles[j]);
      pairs += 1.0;
    }
  }
  return sum / pairs;
}

}  // namespace nysalt
