// SPDX-License-Identifier: BSL-1.0
#include "nysalt/analysis/autocovariance.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <functional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "jackknife.hpp"

namespace nysalt {

std::vector<double> autocovariance::jackknife(
    const std::function<std::vector<double>(const std::vector<double>&)>& f) const {
  const std::vector<double> all = f(normalised());
  std::vector<std::vector<double>> without(all.size());  // number i, without each of the groups
  if (groups_.size() >= 2) {
    for (const auto& group : groups_) {
      autocovariance_sums others = total_;
      for (std::size_t k = 0; k < others.size(); ++k) others[k] = others[k] - group[k];
      const std::vector<double> numbers = f(normalised(others));
      for (std::size_t i = 0; i < all.size(); ++i) without[i].push_back(numbers[i]);
    }
  }
  std::vector<double> variances;
  for (std::size_t i = 0; i < all.size(); ++i) {
    variances.push_back(detail::jackknife_variance(without[i], all[i]));
  }
  return variances;
}

autocovariance::autocovariance(double interval, double centre, std::vector<autocovariance_sums> groups)
    : interval_(interval), centre_(centre) {
  if (groups.empty())
    throw std::invalid_argument("autocovariance: groups of trajectories must be one or more, got none");
  total_.resize(groups.front().size());
  for (auto& group : groups) {
    if (group.size() != total_.size()) {
      throw std::invalid_argument(fmt::format("autocovariance: groups must have equal lags, got {} and {}",
                                              lags(), group.size() - 1));
    }
    if (group.front().pairs == 0.0) continue;
    for (std::size_t k = 0; k < total_.size(); ++k) total_[k] = total_[k] + group[k];
    groups_.push_back(std::move(group));
  }
}

std::vector<double> autocovariance::standard_error() const {
  std::vector<double> result = jackknife([](const std::vector<double>& rho) { return rho; });
  for (double& value : result) value = std::sqrt(value);
  return result;
}

std::vector<double> autocovariance::normalised(const autocovariance_sums& sums) {
  const double variance = sums.front().covariance();
  if (!(variance > 0.0)) {
    throw std::runtime_error(
        "autocovariance: the variance must be > 0, got none: the observable does not vary, "
        "or no trajectory counts");
  }
  std::vector<double> rho;
  for (const pair_sums& at : sums) rho.push_back(at.covariance() / variance);
  return rho;
}

}  // namespace nysalt
