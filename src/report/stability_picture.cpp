// SPDX-License-Identifier: BSL-1.0
#include "stability_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "comparison/stability.hpp"

namespace nysalt::program {

stability_curve stability_curve_of(const method& method, const stability_chart& chart, double highest_z) {
  constexpr int points = 2000;
  const double last = chart.windows.empty() ? 2.0 : chart.windows.back().high;
  const double end = std::max(1.1 * last, std::min(1.3 * highest_z, 4.0 * last));
  stability_curve result;
  for (int i = 0; i <= points; ++i) {
    const double z = end * i / points;
    result.z.push_back(z);
    result.half_trace.push_back(half_trace_of(method, z));
  }
  return result;
}

std::string table_of(const stability_curve& curve) {
  std::string text = "z,half_trace\n";
  for (std::size_t i = 0; i < curve.z.size(); ++i)
    text += fmt::format("{},{}\n", curve.z[i], curve.half_trace[i]);
  return text;
}

panel stability_panel(const std::string& name, const stability_curve& curve, const stability_chart& chart,
                      const std::optional<marked_step>& marked) {
  panel plot{.title = name, .x_label = "z = h omega", .y_label = "trace/2", .curves = {}};
  plot.y_range = "[-1.5:1.5]";  // beyond +-1 it does not matter by how much
  plot.levels = {{"", -1.0}, {"", 1.0}};
  plot.curves.push_back({.label = "trace/2", .x = curve.z, .y = curve.half_trace, .emphasised = true});
  if (!chart.touching.empty()) {
    nysalt::curve& points = plot.curves.emplace_back();
    points.label = "windows touch";
    points.points_only = true;
    for (const double z : chart.touching) {
      const auto next = std::ranges::lower_bound(curve.z, z) - curve.z.begin();
      points.x.push_back(z);
      points.y.push_back(std::copysign(1.0, curve.half_trace[static_cast<std::size_t>(next)]));
    }
  }
  for (const auto& window : chart.windows) plot.intervals.push_back({"stable", window.low, window.high});
  if (!marked) return plot;
  plot.title += fmt::format(", {} at step {:g}", marked->system, marked->step);
  for (const auto& band : marked->bands) {
    const double low = marked->step * band.low;
    if (low >= curve.z.back()) continue;
    plot.intervals.push_back(
        {"frequencies of the system", low, std::min(marked->step * band.high, curve.z.back())});
  }
  return plot;
}

}  // namespace nysalt::program
