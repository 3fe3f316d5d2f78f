// SPDX-License-Identifier: BSL-1.0
#include "quoted.hpp"

#include <algorithm>
#include <string>

namespace nysalt::detail {

std::string on_one_line(std::string text) {
  const auto is_control = [](unsigned char c) { return c < 0x20 || c == 0x7f; };
  std::replace_if(text.begin(), text.end(), is_control, ' ');
  return text;
}

std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : on_one_line(text)) result += c == '\'' ? std::string("''") : std::string(1, c);
  return result + "'";
}

}  // namespace nysalt::detail
