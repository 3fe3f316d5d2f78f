// SPDX-License-Identifier: BSL-1.0
#include "work_precision.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace nysalt {

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
