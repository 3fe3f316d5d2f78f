// SPDX-License-Identifier: BSL-1.0
#include "nysalt/analysis/threshold.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <span>
#include <stdexcept>

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
  if (i == 0) return {.kind = crossing_kind::above_from_first, .x = rows[0].x, .first_above = rows[0].x};
  const error_at& below = rows[i - 1];
  if (i == rows.size()) return {.kind = crossing_kind::below_all, .x = below.x, .last_below = below.x};
  const error_at& above = rows[i];
  threshold_crossing result{crossing_kind::bracketed, below.x};
  result.last_below = below.x;
  result.first_above = above.x;
  if (below.error == 0.0 || !std::isfinite(above.error)) return result;

  const double rise = std::log(above.error / below.error);
  const double share = std::log(level / below.error) / rise;
  const double run = std::log(above.x / below.x);
  const double a = (1.0 - share) * run / rise * below.standard_error / below.error;
  const double b = share * run / rise * above.standard_error / above.error;
  result.kind = crossing_kind::found;
  result.x = below.x * std::exp(share * run);
  result.standard_error = result.x * std::sqrt(a * a + b * b + 2.0 * correlation * a * b);
  return result;
}

}  // namespace nysalt
