// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <string>

namespace nysalt::detail {

/// In single quotes, with what one inside is written as: '' for gnuplot, '\'' for the shell.
inline std::string quoted(const std::string& text, const char* inside = "''") {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? std::string(inside) : std::string(1, c);
  return result + "'";
}

}  // namespace nysalt::detail
