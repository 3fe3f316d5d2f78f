// SPDX-License-Identifier: BSL-1.0
// How long an observable remembers, with error bars.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "nysalt/analysis/autocovariance_sums.hpp"

namespace nysalt {

/// The autocovariance of an observable x in a stationary state at the lags k = 0..L,
///   C(k) = mean x_t x_{t+k} - mean x_t mean x_{t+k},
/// means over all trajectories and times t [li_lu_tao_ye_2023, eq:ACF]; rho(k) = C(k)/C(0).
///
/// Standard errors are those of independent trajectories: the jackknife over groups of them, which leaves out
/// one group after the other; from G groups a standard error is itself known to 1/sqrt(2 (G - 1)) of it.
class autocovariance {
 public:
  /// One term a group of independent trajectories, all with one centre; `interval` is the time between
  /// samples. Groups without a trajectory do not count. Throws std::invalid_argument if there is no group or
  /// their lags differ.
  autocovariance(double interval, double centre, std::vector<autocovariance_sums> groups)
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

  std::size_t lags() const { return total_.size() - 1; }  ///< L, the largest lag
  double interval() const { return interval_; }           ///< time between samples, that of one lag
  /// Number of groups that count.
  std::size_t groups() const { return groups_.size(); }
  /// Mean of the observable; NaN if no trajectory counts.
  double mean() const { return centre_ + total_[0].heads / total_[0].pairs; }
  /// C(k); NaN if no trajectory counts.
  double covariance(std::size_t k) const { return total_.at(k).covariance(); }
  /// rho(0..L). Throws std::runtime_error if the observable did not vary, or no trajectory counts.
  std::vector<double> normalised() const { return normalised(total_); }
  /// Of rho(0..L); NaN if there are fewer than two groups. Throws like normalised().
  std::vector<double> standard_error() const {
    std::vector<double> result = jackknife([](const std::vector<double>& rho) { return rho; });
    for (double& value : result) value = std::sqrt(value);
    return result;
  }

  /// The variances of the numbers f(rho), by the jackknife: (G - 1)/G sum_g (f_g - mean f)^2, where f_g lacks
  /// group g. NaN if there are fewer than two groups. Throws like normalised().
  template <class F>
  std::vector<double> jackknife(const F& f) const {
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

 private:
  static std::vector<double> normalised(const autocovariance_sums& sums) {
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

  double interval_;
  double centre_;
  autocovariance_sums total_;
  std::vector<autocovariance_sums> groups_;
};

}  // namespace nysalt
