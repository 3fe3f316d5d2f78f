// SPDX-License-Identifier: BSL-1.0
#include "paired_ratio.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
#include <utility>

#include "nysalt/analysis/statistics.hpp"

namespace nysalt::program {

namespace {

constexpr double deviations = 2.0;

/// The k-th smallest, from 1 on.
double smallest(std::vector<double>& scores, double k) {
  const double n = static_cast<double>(scores.size());
  const auto at = scores.begin() + static_cast<std::ptrdiff_t>(std::clamp(k, 1.0, n)) - 1;
  std::ranges::nth_element(scores, at);
  return *at;
}

double bound(const error_statistic& statistic, std::vector<double> scores, double sign) {
  const double n = static_cast<double>(scores.size());
  double result = 0.0;
  if (statistic.is_quantile) {
    const double p = error_statistic::share;
    const double k = n * p + sign * deviations * std::sqrt(n * p * (1.0 - p));
    result = smallest(scores, sign > 0.0 ? std::ceil(k) : std::floor(k));
  } else {
    const estimate mean = mean_and_error(scores);
    result = mean.mean + sign * deviations * mean.standard_error;
    if (result < 0.0) result = 0.0;
  }
  return statistic.is_root ? std::sqrt(result) : result;
}

}  // namespace

double error_statistic::operator()(std::vector<double> scores) const {
  const double n = static_cast<double>(scores.size());
  const double result = is_quantile ? smallest(scores, std::ceil(share * n)) : mean_and_error(scores).mean;
  return is_root ? std::sqrt(result) : result;
}

double error_statistic::upper_bound(std::vector<double> scores) const {
  return bound(*this, std::move(scores), 1.0);
}
double error_statistic::lower_bound(std::vector<double> scores) const {
  return bound(*this, std::move(scores), -1.0);
}

ratio_estimate paired_ratio(std::span<const double> a, std::span<const double> b,
                            const error_statistic& statistic) {
  const std::size_t common = std::min(a.size(), b.size());
  a = a.first(common);
  b = b.first(common);
  const auto error = [&](const std::vector<double>& scores) { return statistic(scores); };
  ratio_estimate result;
  result.value = error({a.begin(), a.end()}) / error({b.begin(), b.end()});
  constexpr std::size_t fewest = 8;
  if (a.size() < fewest || !std::isfinite(result.value)) return result;
  constexpr std::size_t resamples = 1000;
  std::mt19937_64 draw;  // the same of all seeds: draws change no ratio, and its interval by some percent
  std::vector<double> ratios(resamples);
  std::vector<double> of_a(a.size());
  std::vector<double> of_b(a.size());
  for (double& ratio : ratios) {
    for (std::size_t i = 0; i < a.size(); ++i) {
      const std::size_t k = draw() % a.size();
      of_a[i] = a[k];
      of_b[i] = b[k];
    }
    ratio = error(of_a) / error(of_b);
  }
  const double out = 0.025 * static_cast<double>(resamples);
  result.low = smallest(ratios, out);
  result.high = smallest(ratios, static_cast<double>(resamples) - out);
  return result;
}

}  // namespace nysalt::program
