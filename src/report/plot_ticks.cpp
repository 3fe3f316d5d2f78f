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
std::vector<double> ticks_within(axis_range range) {
  std::vector<double> result;
  if (!(range.low > 0.0) || !(range.high < 100.0 * range.low)) return result;
  constexpr double rounding = 1e-9;
  for (int decade = static_cast<int>(std::floor(std::log10(range.low))); result.size() < 7; ++decade) {
    const double unit = std::pow(10.0, decade);
    if (unit > range.high) break;
    for (const double digit : {1.0, 2.0, 5.0}) {
      const double tick = digit * unit;
      if (tick >= range.low * (1.0 - rounding) && tick <= range.high * (1.0 + rounding))
        result.push_back(tick);
    }
  }
  return result;
}

}  // namespace

axis_range at_least_threefold(axis_range range) {
  constexpr double least = 3.0;
  const double widen = std::sqrt(least / (range.high / range.low));
  if (!(widen > 1.0)) return range;
  return {range.low / widen, range.high * widen};
}

std::string ticks_command(char axis, axis_range range) {
  const auto ticks = ticks_within(range);
  if (ticks.empty()) return fmt::format("set {}tics autofreq\n", axis);
  std::string text;
  for (const double tick : ticks) text += fmt::format("{}{:.10g}", text.empty() ? "" : ", ", tick);
  return fmt::format("set {}tics ({})\n", axis, text);
}

}  // namespace nysalt::detail
