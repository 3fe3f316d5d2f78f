// SPDX-License-Identifier: BSL-1.0
#include "escaped.hpp"

#include <cctype>
#include <cstddef>
#include <string>
#include <string_view>

namespace nysalt {

std::string markdown_escaped(std::string_view text) {
  constexpr std::string_view read = "\\`*[]<>&|#~";
  const auto in_word = [&](std::size_t i) {
    return i < text.size() && std::isalnum(static_cast<unsigned char>(text[i])) != 0;
  };
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool bare_underscore = i > 0 && in_word(i - 1) && in_word(i + 1);
    if (read.find(text[i]) != std::string_view::npos || (text[i] == '_' && !bare_underscore)) result += '\\';
    result += text[i] == '\n' || text[i] == '\r' ? ' ' : text[i];
  }
  return result;
}

}  // namespace nysalt
