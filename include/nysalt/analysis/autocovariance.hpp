// SPDX-License-Identifier: BSL-1.0
// Autocovariance of an observable, with error bars.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

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
  /// Autocovariance with one term a group of independent trajectories, all with one centre; `interval` is the
  /// time between samples. Groups without a trajectory do not count. Throws std::invalid_argument if there is
  /// no group or their lags differ.
  autocovariance(double interval, double centre, std::vector<autocovariance_sums> groups);

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
  /// Standard errors of rho(0..L); NaN if there are fewer than two groups. Throws like normalised().
  std::vector<double> standard_error() const;

  /// The variances of the numbers f(rho), by the jackknife: (G - 1)/G sum_g (f_g - mean f)^2, where f_g lacks
  /// group g. NaN if there are fewer than two groups. Throws like normalised().
  std::vector<double> jackknife(
      const std::function<std::vector<double>(const std::vector<double>&)>& f) const;

 private:
  static std::vector<double> normalised(const autocovariance_sums& sums);

  double interval_;
  double centre_;
  autocovariance_sums total_;
  std::vector<autocovariance_sums> groups_;
};

}  // namespace nysalt
