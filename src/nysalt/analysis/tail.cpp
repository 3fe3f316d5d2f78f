// SPDX-License-Identifier: BSL-1.0
#include "nysalt/analysis/tail.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "nysalt/detail/tree_sum.hpp"

namespace nysalt {

tail tail_of(std::span<const double> numbers) {
  tail result;
  double largest = 0.0;
  for (const double x : numbers) {
    result.count += std::isnan(x) ? 0.0 : 1.0;
    if (std::abs(x) > largest) largest = std::abs(x);
  }
  if (largest == 0.0) return result;
  std::vector<double> terms(numbers.size());
  // In units of the largest: no power of a small number underflows.
  const auto mean_of = [&](const auto& term) {
    std::ranges::transform(numbers, terms.begin(),
                           [&](double x) { return std::isnan(x) ? 0.0 : term(x / largest); });
    return tree_sum(terms) / result.count;
  };
  const double mean = mean_of([](double x) { return x; });
  const double variance = mean_of([&](double x) { return (x - mean) * (x - mean); });
  const double third = mean_of([&](double x) { return (x - mean) * (x - mean) * (x - mean); });
  result.deciding = result.count * mean * mean / (variance + mean * mean);
  // What differs only by rounding is equal: half a unit in the last place of each number and of the mean.
  const double deviation = std::sqrt(variance);
  if (deviation > std::numeric_limits<double>::epsilon()) {
    result.skewness = third / (variance * deviation);
  }
  return result;
}

}  // namespace nysalt
