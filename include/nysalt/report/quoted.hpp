// SPDX-License-Identifier: BSL-1.0
// Text on its way into gnuplot, and into a shell.
#pragma once

#include <algorithm>
#include <string>

namespace nysalt::detail {

/// What would end a line, and so begin a command or another point, becomes blank.
inline std::string on_one_line(std::string text) {
  const auto is_control = [](unsigned char c) { return c < 0x20 || c == 0x7f; };
  std::replace_if(text.begin(), text.end(), is_control, ' ');
  return text;
}

inline std::string in_single_quotes(const std::string& text, const char* quote) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? std::string(quote) : std::string(1, c);
  return result + "'";
}

/// For gnuplot: a quote is written twice.
inline std::string quoted(const std::string& text) { return in_single_quotes(on_one_line(text), "''"); }
/// For the shell, where a quote stands outside of quotes.
inline std::string quoted_for_shell(const std::string& text) { return in_single_quotes(text, R"('\'')"); }

}  // namespace nysalt::detail
