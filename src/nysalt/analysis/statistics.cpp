// SPDX-License-Identifier: BSL-1.0
#include "nysalt/analysis/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "nysalt/detail/tree_sum.hpp"

namespace nysalt {

estimate mean_and_error(std::span<const double> samples) {
  double n = 0.0;
  for (const double x : samples) n += std::isnan(x) ? 0.0 : 1.0;
  if (n == 0.0) return {};
  const auto mean_of = [&](const auto& term, double divisor) {
    std::vector<double> terms;
    for (const double x : samples) terms.push_back(std::isnan(x) ? 0.0 : term(x));
    return tree_sum(terms) / divisor;
  };
  const double mean = mean_of([](double x) { return x; }, n);
  if (n < 2.0) return {mean, std::numeric_limits<double>::quiet_NaN()};
  const double variance = mean_of([&](double x) { return (x - mean) * (x - mean); }, n - 1.0);
  return {mean, std::sqrt(variance / n)};
}

estimate paired_difference(std::span<const double> a, std::span<const double> b) {
  std::vector<double> differences(a.begin(), a.end());
  for (std::size_t i = 0; i < a.size(); ++i) differences[i] -= b[i];
  return mean_and_error(differences);
}

double median(std::vector<double> samples) {
  if (samples.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::ranges::sort(samples);
  const double upper = samples[samples.size() / 2];
  const double lower = samples[(samples.size() - 1) / 2];
  return lower == upper ? upper : 0.5 * (lower + upper);
}

std::vector<double> sorted_numbers(std::vector<double> samples) {
  std::erase_if(samples, [](double x) { return std::isnan(x); });
  std::ranges::sort(samples);
  return samples;
}

double quantile(std::span<const double> sorted, double p) {
  if (sorted.empty()) return std::numeric_limits<double>::quiet_NaN();
  const double at = p * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  if (below + 1 == sorted.size()) return sorted[below];
  return sorted[below] + (at - static_cast<double>(below)) * (sorted[below + 1] - sorted[below]);
}

estimate median_and_error(std::span<const double> sorted) {
  estimate result{quantile(sorted, 0.5), std::numeric_limits<double>::quiet_NaN()};
  if (sorted.size() < 2) return result;
  const double off = 0.5 / std::sqrt(static_cast<double>(sorted.size()));
  const double above = quantile(sorted, std::min(0.5 + off, 1.0));
  result.standard_error = 0.5 * (above - quantile(sorted, std::max(0.5 - off, 0.0)));
  return result;
}

double slope(std::span<const double> x, std::span<const double> y) {
  const double mean_x = mean_and_error(x).mean;
  const double mean_y = mean_and_error(y).mean;
  double xy = 0.0;
  double xx = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xy += (x[i] - mean_x) * (y[i] - mean_y);
    xx += (x[i] - mean_x) * (x[i] - mean_x);
  }
  return xy / xx;
}

}  // namespace nysalt
