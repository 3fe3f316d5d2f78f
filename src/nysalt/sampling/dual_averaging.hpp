// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

namespace nysalt::detail {

/// A step whose acceptance tends to a target: Nesterov's dual averaging of log h with the constants of
/// [hoffman_gelman_2014, section 3.2.1]. Early steps can be wrong by many powers of ten, so steps are kept
/// between a thousandth of the first guess and a largest step.
class dual_averaging {
 public:
  dual_averaging(double step, double target, double largest)
      : target_(target),
        centre_(std::log(10.0 * step)),
        log_(std::log(std::min(step, largest))),
        low_(log_ - std::log(1000.0)),
        high_(std::log(largest)) {}

  /// After a trajectory that is accepted with this probability.
  void take(double acceptance) {
    constexpr double gamma = 0.05;
    constexpr double t0 = 10.0;
    constexpr double kappa = 0.75;
    count_ += 1.0;
    const double weight = 1.0 / (count_ + t0);
    error_ += weight * (target_ - acceptance - error_);
    log_ = std::clamp(centre_ - error_ * std::sqrt(count_) / gamma, low_, high_);
    const double forgetting = std::pow(count_, -kappa);
    mean_ += forgetting * (log_ - mean_);
  }

  double step() const { return std::exp(log_); }      // to try next
  double settled() const { return std::exp(mean_); }  // to go on with
  /// Whether the acceptance stayed below the target down to the smallest step.
  bool failed() const { return mean_ <= low_ + 1.0; }

  /// All that it remembers, and how it is set to that.
  using memory = std::array<double, 7>;
  memory saved() const { return {centre_, log_, mean_, error_, count_, low_, high_}; }
  void restore(const memory& saved) {
    centre_ = saved[0];
    log_ = saved[1];
    mean_ = saved[2];
    error_ = saved[3];
    count_ = saved[4];
    low_ = saved[5];
    high_ = saved[6];
  }

 private:
  double target_;
  double centre_;
  double log_;
  double low_;
  double high_;
  double mean_ = 0.0;
  double error_ = 0.0;
  double count_ = 0.0;
};

}  // namespace nysalt::detail
