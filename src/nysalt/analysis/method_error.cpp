// SPDX-License-Identifier: BSL-1.0
#include "nysalt/analysis/method_error.hpp"

#include <cstddef>
#include <iterator>
#include <vector>

namespace nysalt {

method_error error_of_runs(const std::vector<run_score>& runs, const error_measure& measure,
                           std::span<const double> sizes) {
  method_error result;
  std::vector<double> scores;
  for (const auto& run : runs) {
    if (run.diverged_at) result.diverged_at.push_back({std::ssize(scores), *run.diverged_at});
    scores.push_back(run.value);
  }
  result.diverged = std::ssize(result.diverged_at);
  result.error = measure.average(scores, sizes);
  result.of_each = measure.parts(scores, sizes);
  result.spread = {.largest = tail_of(scores), .median = {}, .quantiles = {}};
  result.own = measure.of_each(scores, sizes);
  const auto own = sorted_numbers(result.own);
  result.spread.median = median_and_error(own);
  for (std::size_t i = 0; i < shown_quantiles.size(); ++i) {
    result.spread.quantiles[i] = quantile(own, shown_quantiles[i]);
  }
  return result;
}

}  // namespace nysalt
