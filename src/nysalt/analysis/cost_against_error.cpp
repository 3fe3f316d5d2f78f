// SPDX-License-Identifier: BSL-1.0

#include "nysalt/analysis/cost_against_error.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <span>
#include <stdexcept>
#include <tuple>
#include <vector>

#include "nysalt/analysis/statistics.hpp"
#include "nysalt/noises/counter_noise.hpp"
#include "nysalt/word.hpp"

namespace nysalt::detail {

std::int64_t evaluations_of_run(const model& system, const method& method, double step, std::int64_t steps,
                                const phase_point<double, Eigen::Dynamic>& start) {
  if (steps < 0)
    throw std::invalid_argument(fmt::format("evaluations_of_run: steps must not be negative, got {}", steps));
  make_stepper(system, method, step, counter_noise(0));  // refuses what cannot be stepped
  if (!is_black_box(system)) {
    nysalt::word word = method.letters();
    if (!system.bath().acts()) word = conservative_part(word);
    if (word.is_processed() && steps == 0) return 0;
    return evaluations_of(
        system, word.evaluations_to_open + steps * word.evaluations_per_step + word.evaluations_to_observe,
        steps * word.force_derivatives);
  }
  const model watched = system.separate();
  const auto stepper = make_stepper(watched, method, step, counter_noise(0));  // any noise
  auto run = stepper.open(start);
  std::int64_t before_last = watched.calls();
  for (std::int64_t n = 0; n < std::min<std::int64_t>(steps, 2); ++n) {
    before_last = watched.calls();
    stepper.advance(run, 1);  // before the first no force may be known
  }
  const std::int64_t more = std::max<std::int64_t>(steps - 2, 0) * (watched.calls() - before_last);
  stepper.synchronous(run);
  return watched.calls() + more;
}

}  // namespace nysalt::detail

namespace nysalt {

namespace {

void require_rows(std::span<const error_at> rows, double level) {
  if (rows.empty() || !(level > 0.0) || !std::isfinite(level)) {
    throw std::invalid_argument(
        fmt::format("threshold: rows must be one or more and the level positive and finite, got {} rows "
                    "and the level {}",
                    rows.size(), level));
  }
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const bool sorted = i < 2 || (rows[i].x > rows[i - 1].x) == (rows[1].x > rows[0].x);
    const bool differs = i == 0 || rows[i].x != rows[i - 1].x;
    if (rows[i].x > 0.0 && std::isfinite(rows[i].x) && sorted && differs && !(rows[i].error < 0.0)) continue;
    throw std::invalid_argument(
        fmt::format("threshold: abscissas must be positive and sorted from the accurate end on, and "
                    "errors >= 0, got row {} at {} with error {}",
                    i + 1, rows[i].x, rows[i].error));
  }
}

}  // namespace

threshold_crossing threshold(std::span<const error_at> rows, double level, double correlation) {
  require_rows(rows, level);
  std::size_t i = 0;
  while (i < rows.size() && rows[i].error < level) ++i;
  if (i == 0)
    return {.kind = threshold_crossing::crossing_kind::above_from_first,
            .x = rows[0].x,
            .first_above = rows[0].x};
  const error_at& below = rows[i - 1];
  if (i == rows.size())
    return {.kind = threshold_crossing::crossing_kind::below_all, .x = below.x, .last_below = below.x};
  const error_at& above = rows[i];
  threshold_crossing result{threshold_crossing::crossing_kind::bracketed, below.x};
  result.last_below = below.x;
  result.first_above = above.x;
  if (below.error == 0.0 || !std::isfinite(above.error)) return result;

  const double rise = std::log(above.error / below.error);
  const double share = std::log(level / below.error) / rise;
  const double run = std::log(above.x / below.x);
  const double a = (1.0 - share) * run / rise * below.standard_error / below.error;
  const double b = share * run / rise * above.standard_error / above.error;
  result.kind = threshold_crossing::crossing_kind::found;
  result.x = below.x * std::exp(share * run);
  result.standard_error = result.x * std::sqrt(a * a + b * b + 2.0 * correlation * a * b);
  return result;
}

std::vector<timed_job> interleaved_seconds(const std::vector<std::function<void()>>& jobs, int rounds) {
  std::vector<std::vector<double>> seconds(jobs.size());
  for (int round = 0; round <= rounds; ++round) {
    for (std::size_t j = 0; j < jobs.size(); ++j) {
      const auto began = std::chrono::steady_clock::now();
      jobs[j]();
      const auto ended = std::chrono::steady_clock::now();
      if (round > 0) seconds[j].push_back(std::chrono::duration<double>(ended - began).count());
    }
  }
  std::vector<timed_job> result(jobs.size());
  for (std::size_t j = 0; j < jobs.size() && rounds > 0; ++j) {
    result[j] = {std::ranges::min(seconds[j]), median(seconds[j]), rounds};
  }
  return result;
}

std::vector<std::size_t> pareto_front(std::span<const cost_and_error> all) {
  std::vector<std::size_t> candidates;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (std::isfinite(all[i].cost) && std::isfinite(all[i].error)) candidates.push_back(i);
  }
  std::ranges::sort(candidates, {}, [&](std::size_t i) { return std::tuple(all[i].cost, all[i].error, i); });
  std::vector<std::size_t> front;
  double least = std::numeric_limits<double>::infinity();
  for (const std::size_t i : candidates) {
    if (!(all[i].error < least)) continue;
    least = all[i].error;
    front.push_back(i);
  }
  return front;
}

}  // namespace nysalt
