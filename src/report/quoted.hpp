// SPDX-License-Identifier: BSL-1.0
// Text on the way into gnuplot.
#pragma once

#include <string>

namespace nysalt::detail {

/// What would end a line, and so begin a command or another point, becomes blank.
std::string on_one_line(std::string text);

/// For gnuplot: a quote is written twice.
std::string quoted(const std::string& text);

}  // namespace nysalt::detail
