// SPDX-License-Identifier: BSL-1.0
#include "low_error.hpp"

#include <algorithm>
#include <cmath>
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

namespace {

using curves_of_chains = std::vector<const std::vector<double>*>;

std::vector<double> median_of(const curves_of_chains& chains) {
  std::vector<double> result(chains.front()->size());
  std::vector<double> at(chains.size());
  for (std::size_t n = 0; n < result.size(); ++n) {
    for (std::size_t m = 0; m < chains.size(); ++m) at[m] = (*chains[m])[n];
    std::ranges::sort(at);
    const std::size_t middle = at.size() / 2;
    result[n] = at.size() % 2 == 1 ? at[middle] : 0.5 * (at[middle - 1] + at[middle]);
  }
  return result;
}

double draws_until_low(const std::vector<double>& errors, double limit) {
  if (!(errors.back() < limit)) return std::numeric_limits<double>::infinity();
  const auto last_above =
      std::find_if(errors.rbegin(), errors.rend(), [&](double e) { return !(e < limit); });
  return static_cast<double>(errors.rend() - last_above) + 1.0;
}

curves_of_chains chosen(const std::vector<error_curve>& chains, std::vector<double> error_curve::*which) {
  curves_of_chains result;
  for (const auto& one : chains) result.push_back(&(one.*which));
  return result;
}

}  // namespace

std::vector<double> median_curve(const std::vector<error_curve>& chains,
                                 std::vector<double> error_curve::*which) {
  return median_of(chosen(chains, which));
}

double draws_to_low_error(const std::vector<error_curve>& chains, std::vector<double> error_curve::*which,
                          double limit) {
  return draws_until_low(median_curve(chains, which), limit);
}

double deviation_of_draws(const std::vector<error_curve>& chains, std::vector<double> error_curve::*which,
                          double limit) {
  const curves_of_chains all = chosen(chains, which);
  std::vector<double> found;
  std::vector<std::size_t> choice(all.size(), 0);
  for (bool is_last = false; !is_last;) {
    curves_of_chains resampled;
    for (const std::size_t m : choice) resampled.push_back(all[m]);
    const double draws = draws_until_low(median_of(resampled), limit);
    if (std::isfinite(draws)) found.push_back(draws);
    std::size_t k = 0;
    while (k < choice.size() && ++choice[k] == all.size()) choice[k++] = 0;
    is_last = k == choice.size();
  }
  double mean = 0.0;
  for (const double x : found) mean += x / static_cast<double>(found.size());
  double squares = 0.0;
  for (const double x : found) squares += (x - mean) * (x - mean) / static_cast<double>(found.size());
  return std::sqrt(squares);
}

}  // namespace nysalt::sampling_benchmark
