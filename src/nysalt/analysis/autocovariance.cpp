// SPDX-License-Identifier: BSL-1.0
#include "nysalt/analysis/autocovariance.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

namespace nysalt {

std::vector<double> autocovariance::jackknife(
    const std::function<std::vector<double>(const std::vector<double>&)>& f) const {
  const std::vector<double> all = f(normalised());
  if (groups_.size() < 2) return std::vector<double>(all.size(), std::numeric_limits<double>::quiet_NaN());
  std::vector<double> sum(all.size());
  std::vector<double> squares(all.size());
  for (const auto& group : groups_) {
    autocovariance_sums others = total_;
    for (std::size_t k = 0; k < others.size(); ++k) others[k] = others[k] - group[k];
    const std::vector<double> without = f(normalised(others));
    for (std::size_t i = 0; i < all.size(); ++i) {
      const double change = without[i] - all[i];
      sum[i] += change;
      squares[i] += change * change;
    }
  }
  const auto n = static_cast<double>(groups_.size());
  for (std::size_t i = 0; i < all.size(); ++i) squares[i] -= sum[i] * sum[i] / n;
  for (double& value : squares) value = std::max(value, 0.0) * ((n - 1.0) / n);
  return squares;
}

autocovariance::autocovariance(double interval, double centre, std::vector<autocovariance_sums> groups)
    : interval_(interval), centre_(centre) {
  if (groups.empty()) throw std::invalid_argument("autocovariance: there is no group of trajectories");
  total_.resize(groups.front().size());
  for (auto& group : groups) {
    if (group.size() != total_.size()) {
      throw std::invalid_argument(fmt::format(
          "autocovariance: groups of {} and of {} lags do not go together", lags(), group.size() - 1));
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
        "autocovariance: the observable does not vary, or no trajectory counts: there is nothing to divide "
        "by");
  }
  std::vector<double> rho;
  for (const pair_sums& at : sums) rho.push_back(at.covariance() / variance);
  return rho;
}

}  // namespace nysalt
