// SPDX-License-Identifier: BSL-1.0
#include "nysalt/analysis/statistics.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <span>
#include <stdexcept>
#include <vector>

#include "jackknife.hpp"

namespace nysalt {

namespace {

histogram sum_of(std::span<const histogram> groups) {
  if (groups.empty())
    throw std::invalid_argument("total_variation: groups of trajectories must be one or more, got none");
  histogram all(groups.front().bins());
  for (const histogram& group : groups) all += group;
  return all;
}

/// The variance of distance(all) by the jackknife over groups; groups without a trajectory do not count.
template <class Distance>
double jackknife_variance(std::span<const histogram> groups, const histogram& all, const Distance& distance) {
  std::vector<double> without;
  for (const histogram& group : groups) {
    if (group.total() == 0) continue;
    histogram others = all;
    others -= group;
    if (others.total() > 0) without.push_back(distance(others));
  }
  return detail::jackknife_variance(without, distance(all));
}

}  // namespace

double total_variation(const histogram& a, const histogram& b) {
  a.require_bins_of(b);
  const auto p = a.fractions();
  const auto q = b.fractions();
  double sum = 0.0;
  for (std::size_t i = 0; i < p.size(); ++i) sum += std::abs(p[i] - q[i]);
  return 0.5 * sum;
}

double mean_total_variation(const histogram& given, std::span<const histogram> ensembles) {
  if (ensembles.empty())
    throw std::invalid_argument(
        "mean_total_variation: ensembles to compare with must be one or more, got none");
  double sum = 0.0;
  for (const histogram& other : ensembles) sum += total_variation(given, other);
  return sum / static_cast<double>(ensembles.size());
}

estimate mean_total_variation(std::span<const histogram> groups,
                              std::span<const std::vector<histogram>> ensembles) {
  const histogram given = sum_of(groups);
  std::vector<histogram> others;
  for (const auto& ensemble : ensembles) others.push_back(sum_of(ensemble));
  const double mean = mean_total_variation(given, others);
  double variance = jackknife_variance(
      groups, given, [&](const histogram& without) { return mean_total_variation(without, others); });
  const auto count = static_cast<double>(others.size());
  for (std::size_t k = 0; k < others.size(); ++k) {
    variance += jackknife_variance(ensembles[k], others[k], [&](const histogram& without) {
      return total_variation(given, without) / count;
    });
  }
  return {mean, std::sqrt(variance)};
}

double sampling_floor(std::span<const histogram> ensembles) {
  if (ensembles.size() < 4) {
    throw std::invalid_argument(fmt::format(
        "sampling_floor: independent ensembles must be 4 or more (6 pairs), got {}", ensembles.size()));
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
