// SPDX-License-Identifier: BSL-1.0
#include "quoted.hpp"

#include <algorithm>
#include <string>

namespace nysalt::detail {

namespace {

std::string in_single_quotes(const std::string& text, const char* quote) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? std::string(quote) : std::string(1, c);
  return result + "'";
}

}  // namespace

std::string on_one_line(std::string text) {
  const auto is_control = [](unsigned char c) { return c < 0x20 || c == 0x7f; };
  std::replace_if(text.begin(), text.end(), is_control, ' ');
  return text;
}

std::string quoted(const std::string& text) { return in_single_quotes(on_one_line(text), "''"); }

std::string quoted_for_shell(const std::string& text) { return in_single_quotes(text, R"('\'')"); }

}  // namespace nysalt::detail
