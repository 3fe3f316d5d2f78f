// SPDX-License-Identifier: BSL-1.0
// The numbers beside a logarithmic axis.
#pragma once

#include <string>

namespace nysalt::detail {

/// Ends of an axis.
struct axis_range {
  double low;
  double high;
};

/// At least from one to three times as much, about the middle: then it holds 1, 2 or 5 times a power of ten,
/// as none of those is more than 2.5 times the next.
axis_range at_least_threefold(axis_range range);

/// For gnuplot: the numbers 1, 2 and 5 times powers of ten within, or those that it thinks best.
std::string ticks_command(char axis, axis_range range);

}  // namespace nysalt::detail
