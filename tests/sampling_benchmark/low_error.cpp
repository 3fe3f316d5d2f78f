// SPDX-License-Identifier: BSL-1.0
#include "low_error.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>

namespace nysalt::sampling_benchmark {

running_errors::running_errors(const statistic& of, std::int64_t chains)
    : of_(of),
      sums_(static_cast<std::size_t>(chains), Eigen::VectorXd::Zero(of.mean.size())),
      values_(sums_),
      curves_(sums_.size()) {}

void running_errors::take(std::int64_t chain, const Eigen::VectorXd& q) {
  const auto m = static_cast<std::size_t>(chain);
  of_.value(q, values_[m]);
  sums_[m] += values_[m];
  const double draws = static_cast<double>(curves_[m].mean.size() + 1);
  double sum = 0.0;
  double largest = 0.0;
  for (Eigen::Index i = 0; i < of_.mean.size(); ++i) {
    const double bias = sums_[m][i] / draws - of_.mean[i];
    const double error = bias * bias / of_.variance[i];
    sum += error;
    largest = std::max(largest, error);
  }
  curves_[m].mean.push_back(sum / static_cast<double>(of_.mean.size()));
  curves_[m].largest.push_back(largest);
}

std::vector<double> median_curve(const std::vector<error_curve>& chains,
                                 std::vector<double> error_curve::*which) {
  std::vector<double> result((chains.front().*which).size());
  std::vector<double> of_chains(chains.size());
  for (std::size_t n = 0; n < result.size(); ++n) {
    for (std::size_t m = 0; m < chains.size(); ++m) of_chains[m] = (chains[m].*which)[n];
    std::ranges::sort(of_chains);
    const std::size_t middle = of_chains.size() / 2;
    result[n] =
        of_chains.size() % 2 == 1 ? of_chains[middle] : 0.5 * (of_chains[middle - 1] + of_chains[middle]);
  }
  return result;
}

double draws_to_low_error(const std::vector<error_curve>& chains, std::vector<double> error_curve::*which,
                          double limit) {
  const auto errors = median_curve(chains, which);
  if (!(errors.back() < limit)) return std::numeric_limits<double>::infinity();
  const auto last_above =
      std::find_if(errors.rbegin(), errors.rend(), [&](double e) { return !(e < limit); });
  return static_cast<double>(errors.rend() - last_above) + 1.0;
}

}  // namespace nysalt::sampling_benchmark
