// SPDX-License-Identifier: BSL-1.0
// What a method costs beside how far it errs: always together.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "nysalt/analysis/statistics.hpp"
#include "nysalt/report/plot.hpp"
#include "nysalt/report/table.hpp"

namespace nysalt {

struct work_precision_row {
  std::string method;
  double step;
  double evaluations_per_time;  // force evaluations of a trajectory per unit time, counted
  double seconds_per_time;      // measured
  estimate error;               // NaN if every trajectory diverged
  std::int64_t diverged;
  std::int64_t trajectories;
};

inline table work_precision_table(const std::vector<work_precision_row>& rows) {
  table result({"method", "step", "evaluations/time", "ns/time", "error", "standard error", "diverged"});
  const auto number = [](double x) { return std::isfinite(x) ? fmt::format("{:.2e}", x) : std::string("-"); };
  for (const auto& row : rows) {
    result.add({row.method, fmt::format("{:g}", row.step), fmt::format("{:.1f}", row.evaluations_per_time),
                fmt::format("{:.0f}", 1e9 * row.seconds_per_time), number(row.error.mean),
                number(row.error.standard_error), fmt::format("{}/{}", row.diverged, row.trajectories)});
  }
  return result;
}

/// A method's error at a cost: that of the row nearest to it if that is within 5 % (evaluations to start up
/// make as much in a short run), else on a straight log-log line between its neighbours; nothing outside.
/// Rows with diverged trajectories do not count.
inline std::optional<double> error_at_cost(const std::vector<work_precision_row>& rows,
                                           const std::string& method, double evaluations_per_time) {
  const work_precision_row* below = nullptr;
  const work_precision_row* above = nullptr;
  for (const auto& row : rows) {
    if (row.method != method || row.diverged > 0) continue;
    const double cost = row.evaluations_per_time;
    if (cost <= evaluations_per_time && (below == nullptr || cost > below->evaluations_per_time))
      below = &row;
    if (cost >= evaluations_per_time && (above == nullptr || cost < above->evaluations_per_time))
      above = &row;
  }
  const auto distance = [&](const work_precision_row* row) {
    return row == nullptr ? std::numeric_limits<double>::infinity()
                          : std::abs(row->evaluations_per_time / evaluations_per_time - 1.0);
  };
  const auto* nearest = distance(below) <= distance(above) ? below : above;
  if (distance(nearest) <= 0.05) return nearest->error.mean;
  if (below == nullptr || above == nullptr) return std::nullopt;
  const double s = std::log(evaluations_per_time / below->evaluations_per_time) /
                   std::log(above->evaluations_per_time / below->evaluations_per_time);
  return std::exp((1.0 - s) * std::log(below->error.mean) + s * std::log(above->error.mean));
}

/// Error against a cost, a curve a method, from cheap to dear; rows without a finite error leave a gap.
inline panel work_precision_panel(std::vector<work_precision_row> rows, const std::string& emphasised,
                                  const std::string& x_label, double work_precision_row::*cost) {
  panel result;
  result.x_label = x_label;
  result.log_log = true;
  const auto curve_of = [&](const std::string& method) {
    return std::find_if(result.curves.begin(), result.curves.end(),
                        [&](const curve& c) { return c.label == method; });
  };
  for (const auto& row : rows) {  // curves in the order of the table
    if (curve_of(row.method) != result.curves.end()) continue;
    result.curves.push_back({.label = row.method, .x = {}, .y = {}, .emphasised = row.method == emphasised});
  }
  std::stable_sort(rows.begin(), rows.end(), [&](const auto& a, const auto& b) { return a.*cost < b.*cost; });
  for (const auto& row : rows) {
    const auto at = curve_of(row.method);
    at->x.push_back(row.*cost);
    at->y.push_back(row.error.mean);
    at->error.push_back(row.error.standard_error);
  }
  return result;
}

}  // namespace nysalt
