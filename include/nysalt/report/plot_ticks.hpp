// SPDX-License-Identifier: BSL-1.0
// Which numbers stand beside a logarithmic axis.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <vector>

namespace nysalt::detail {

/// Ends of an axis.
struct axis_range {
  double low;
  double high;
};

/// At least from one to three times as much, about the middle: then it holds 1, 2 or 5 times a power of ten,
/// as none of those is more than 2.5 times the next.
inline axis_range at_least_threefold(axis_range its) {
  constexpr double least = 3.0;
  const double widen = std::sqrt(least / (its.high / its.low));
  if (!(widen > 1.0)) return its;
  return {its.low / widen, its.high * widen};
}

/// The numbers 1, 2 and 5 times powers of ten within; none where there are two decades or more, of which the
/// powers of ten are numbers enough.
inline std::vector<double> ticks_within(axis_range its) {
  std::vector<double> result;
  if (!(its.low > 0.0) || !(its.high < 100.0 * its.low)) return result;
  constexpr double rounding = 1e-9;
  for (int decade = static_cast<int>(std::floor(std::log10(its.low))); result.size() < 7; ++decade) {
    const double unit = std::pow(10.0, decade);
    if (unit > its.high) break;
    for (const double digit : {1.0, 2.0, 5.0}) {
      const double tick = digit * unit;
      if (tick >= its.low * (1.0 - rounding) && tick <= its.high * (1.0 + rounding)) result.push_back(tick);
    }
  }
  return result;
}

/// For gnuplot: those, or as it thinks best.
inline std::string ticks_command(char axis, axis_range its) {
  const auto ticks = ticks_within(its);
  if (ticks.empty()) return fmt::format("set {}tics autofreq\n", axis);
  std::string text;
  for (const double tick : ticks) text += fmt::format("{}{:.10g}", text.empty() ? "" : ", ", tick);
  return fmt::format("set {}tics ({})\n", axis, text);
}

}  // namespace nysalt::detail
