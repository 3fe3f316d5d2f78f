// SPDX-License-Identifier: BSL-1.0
// Means and variances of chains, from which masses follow.
#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <span>
#include <vector>

#include "nysalt/shard.hpp"

namespace nysalt::detail {

/// Numbers of a state that is saved, one after the other.
class saved_numbers {
 public:
  explicit saved_numbers(std::span<double> numbers) : left_(numbers) {}
  void put(double x) {
    left_.front() = x;
    left_ = left_.subspan(1);
  }
  double get() {
    const double x = left_.front();
    left_ = left_.subspan(1);
    return x;
  }

 private:
  std::span<double> left_;
};

/// Mean and variance of the draws of a chain, by Welford's recurrence.
struct moments {
  double count = 0.0;
  Eigen::VectorXd mean;
  Eigen::VectorXd squares;

  void take(const Eigen::VectorXd& x) {
    if (count == 0.0) mean = squares = Eigen::VectorXd::Zero(x.size());
    count += 1.0;
    const Eigen::VectorXd before = x - mean;
    mean += before / count;
    squares += before.cwiseProduct(x - mean);
  }

  static Eigen::Index width(Eigen::Index size) { return 1 + 2 * size; }  // numbers that are saved
  void write(Eigen::Index size, saved_numbers& row) const {
    row.put(count);
    for (Eigen::Index i = 0; i < size; ++i) row.put(count > 0.0 ? mean[i] : 0.0);
    for (Eigen::Index i = 0; i < size; ++i) row.put(count > 0.0 ? squares[i] : 0.0);
  }
  void read(Eigen::Index size, saved_numbers& row) {
    count = row.get();
    mean = squares = Eigen::VectorXd::Zero(size);
    for (double& x : mean) x = row.get();
    for (double& x : squares) x = row.get();
  }
};

/// The standard deviation of each coordinate over all chains, about the mean of all. Throws
/// std::runtime_error if a coordinate did not vary.
Eigen::VectorXd deviations_of(const std::vector<moments>& of_chains, const shard& mine, std::int64_t chains,
                              Eigen::Index size);

}  // namespace nysalt::detail
