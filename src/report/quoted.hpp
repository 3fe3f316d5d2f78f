// SPDX-License-Identifier: BSL-1.0
// Text on its way into gnuplot, and into a shell.
#pragma once

#include <string>

namespace nysalt::detail {

/// What would end a line, and so begin a command or another point, becomes blank.
std::string on_one_line(std::string text);

/// For gnuplot: a quote is written twice.
std::string quoted(const std::string& text);
/// For the shell, where a quote is outside of quotes.
std::string quoted_for_shell(const std::string& text);

}  // namespace nysalt::detail
