// SPDX-License-Identifier: BSL-1.0
#include "work_precision.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace nysalt {

table work_precision_table(const std::vector<work_precision_row>& rows, const std::string& value) {
  std::vector<std::string> columns{"method", "step",           "evaluations/time", "ns/time",
                                   value,    "standard error", "diverged"};
  const bool has_floor =
      std::any_of(rows.begin(), rows.end(), [](const auto& row) { return row.floor.has_value(); });
  if (has_floor) columns.insert(columns.end() - 1, "floor");
  table result(columns);
  const auto number = [](double x) { return std::isfinite(x) ? fmt::format("{:.2e}", x) : std::string("-"); };
  for (const auto& row : rows) {
    std::vector<std::string> cells{row.method,
                                   fmt::format("{:g}", row.step),
                                   fmt::format("{:.1f}", row.evaluations_per_time),
                                   fmt::format("{:.0f}", 1e9 * row.seconds_per_time),
                                   number(row.error.mean),
                                   number(row.error.standard_error)};
    if (has_floor) cells.push_back(row.floor ? number(*row.floor) : "-");
    cells.push_back(fmt::format("{}/{}", row.diverged, row.trajectories));
    result.add(std::move(cells));
  }
  return result;
}

panel work_precision_panel(std::vector<work_precision_row> rows, const std::string& emphasised,
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
    const bool thick = row.learned || row.method == emphasised;
    result.curves.push_back({.label = row.method, .x = {}, .y = {}, .emphasised = thick});
  }
  std::stable_sort(rows.begin(), rows.end(), [&](const auto& a, const auto& b) { return a.*cost < b.*cost; });
  for (const auto& row : rows) {
    const auto at = curve_of(row.method);
    at->x.push_back(row.*cost);
    at->y.push_back(row.error.mean);
    at->error.push_back(row.error.standard_error);
    at->hollow.push_back(!row.counts);
  }
  return result;
}

curve front_curve(const std::vector<work_precision_row>& rows, std::vector<std::size_t> front,
                  double work_precision_row::*cost, const std::string& label) {
  std::sort(front.begin(), front.end(),
            [&](std::size_t a, std::size_t b) { return rows.at(a).*cost < rows.at(b).*cost; });
  curve result{.label = label, .x = {}, .y = {}, .front = true};
  for (const std::size_t place : front) {
    result.x.push_back(rows.at(place).*cost);
    result.y.push_back(rows.at(place).error.mean);
  }
  return result;
}

}  // namespace nysalt
