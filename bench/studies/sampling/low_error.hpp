// SPDX-License-Identifier: BSL-1.0
// When the mean of a statistic along chains has a low error.
#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <functional>
#include <vector>

namespace nysalt::sampling_benchmark {

/// Several functions of a state at once, f_i(q), whose mean and variance are known.
struct statistic {
  std::function<void(const Eigen::VectorXd& q, Eigen::VectorXd& f)> value;  // from several threads
  Eigen::VectorXd mean;
  Eigen::VectorXd variance;
};

/// The squared bias of the means of a chain so far, each over the variance of f_i: over all i the mean and
/// the largest.
struct error_curve {
  std::vector<double> mean;
  std::vector<double> largest;
};

/// Error curves of chains, draw after draw.
class running_errors {
 public:
  running_errors(const statistic& of, std::int64_t chains);

  /// The next draw of a chain; several chains at a time, from several threads.
  void take(std::int64_t chain, const Eigen::VectorXd& q);
  const std::vector<error_curve>& curves() const { return curves_; }

 private:
  const statistic& of_;
  std::vector<Eigen::VectorXd> sums_;
  std::vector<Eigen::VectorXd> values_;
  std::vector<error_curve> curves_;
};

/// The number of draws after which the median over chains of the error stays below the limit; infinite if the
/// last one is above it.
double draws_to_low_error(const std::vector<error_curve>& chains, std::vector<double> error_curve::*which,
                          double limit = 0.01);

/// Its standard deviation over all choices of as many chains with replacement (the bootstrap, in full: for
/// few chains), of those that are finite.
double deviation_of_draws(const std::vector<error_curve>& chains, std::vector<double> error_curve::*which,
                          double limit = 0.01);

/// The median over chains, draw after draw.
std::vector<double> median_curve(const std::vector<error_curve>& chains,
                                 std::vector<double> error_curve::*which);

}  // namespace nysalt::sampling_benchmark
