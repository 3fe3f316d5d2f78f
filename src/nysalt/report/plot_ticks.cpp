// SPDX-License-Identifier: BSL-1.0
#include "plot_ticks.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <vector>

namespace nysalt::detail {

namespace {

/// The numbers 1, 2 and 5 times powers of ten within; none where there are two decades or more, of which the
/// powers of ten are numbers enough.
std::vector<double> ticks_within(axis_range its) {
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

}  // namespace

axis_range at_least_threefold(axis_range its) {
  constexpr double least = 3.0;
  const double widen = std::sqrt(least / (its.high / its.low));
  if (!(widen > 1.0)) return its;
  return {its.low / widen, its.high * widen};
}

std::string ticks_command(char axis, axis_range its) {
  const auto ticks = ticks_within(its);
  if (ticks.empty()) return fmt::format("set {}tics autofreq\n", axis);
  std::string text;
  for (const double tick : ticks) text += fmt::format("{}{:.10g}", text.empty() ? "" : ", ", tick);
  return fmt::format("set {}tics ({})\n", axis, text);
}

}  // namespace nysalt::detail
