// SPDX-License-Identifier: BSL-1.0
#include "nysalt/analysis/error_measure.hpp"

#include <cmath>
#include <cstddef>
#include <vector>

namespace nysalt {

double error_measure::score(double sum, double weights) const {
  const double mean = sum / weights;
  return how == averaging::root_of_each ? std::sqrt(mean) : mean;
}

double error_measure::unit(std::span<const double> sizes) const {
  if (!relative_to || sizes.empty()) return 1.0;
  const double mean = mean_and_error(sizes).mean;
  return how == averaging::mean ? mean : std::sqrt(mean);
}

estimate error_measure::average(std::span<const double> scores, std::span<const double> sizes) const {
  const estimate mean = mean_and_error(scores);
  const double root = how == averaging::root_of_all ? std::sqrt(mean.mean) : mean.mean;
  if (relative_to && !sizes.empty())
    return {root / unit(sizes), mean_and_error(parts(scores, sizes)).standard_error};
  if (how != averaging::root_of_all || mean.mean == 0.0) return mean;
  return {root, mean.standard_error / (2.0 * root)};
}

std::vector<double> error_measure::parts(std::span<const double> scores,
                                         std::span<const double> sizes) const {
  std::vector<double> result(scores.begin(), scores.end());
  const double mean = mean_and_error(scores).mean;
  const bool is_root = how == averaging::root_of_all && mean != 0.0;
  const double root = is_root ? std::sqrt(mean) : mean;
  if (is_root) {
    for (double& x : result) x = root + (x - mean) / (2.0 * root);
  }
  if (!relative_to || sizes.empty()) return result;
  const double unit_of_all = unit(sizes);
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
    result[i] = (result[i] - slope * (sizes[i] - seen)) / unit_of_all;
  }
  return result;
}

std::vector<double> error_measure::of_each(std::span<const double> scores,
                                           std::span<const double> sizes) const {
  std::vector<double> result(scores.begin(), scores.end());
  const double unit_of_all = unit(sizes);
  for (double& x : result) x = (how == averaging::root_of_all ? std::sqrt(x) : x) / unit_of_all;
  return result;
}

}  // namespace nysalt
