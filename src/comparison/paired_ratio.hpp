// SPDX-License-Identifier: BSL-1.0
// Ratio of two errors, from trajectories that both methods ran.
#pragma once

#include <limits>
#include <span>
#include <vector>

namespace nysalt::program {

/// The statistic by which the scores of trajectories, one each, become one error.
struct error_statistic {
  bool is_root;      // a score is a mean square, and the error the root of what follows
  bool is_quantile;  // 95 of 100 trajectories err less; else the mean over trajectories

  static constexpr double share = 0.95;

  double operator()(std::vector<double> scores) const;
  /// Upper bound of the error of all trajectories with 97.7 % confidence: the mean and two standard errors;
  /// of a quantile the score with as many below it as the binomial distribution has with two standard
  /// deviations, and of too few trajectories the largest. NaN of the mean of one trajectory.
  double upper_bound(std::vector<double> scores) const;
  /// The same from below.
  double lower_bound(std::vector<double> scores) const;
};

/// A ratio and its interval of 95 %; NaN where trajectories are too few.
struct ratio_estimate {
  double value = std::numeric_limits<double>::quiet_NaN();
  double low = std::numeric_limits<double>::quiet_NaN();
  double high = std::numeric_limits<double>::quiet_NaN();

  bool is_above_one() const { return low > 1.0; }
  bool is_below_one() const { return high < 1.0; }
  ratio_estimate inverse() const { return {1.0 / value, 1.0 / high, 1.0 / low}; }
};

/// The error of a over that of b, of the first trajectories, which both ran: score i of both is of the same
/// one. The interval is that of the
/// percentile bootstrap over trajectories [efron_tibshirani_1993, chapter 13], so that what both share of
/// chance cancels; below eight trajectories there is none. Equal scores give equal bits.
ratio_estimate paired_ratio(std::span<const double> a, std::span<const double> b,
                            const error_statistic& statistic);

}  // namespace nysalt::program
