// SPDX-License-Identifier: BSL-1.0
// Text that says itself, whatever characters it has, in HTML and in Markdown.
#pragma once

#include <cctype>
#include <string>
#include <string_view>

namespace nysalt {

/// In the text of an element, or in an attribute between quotes.
inline std::string html_escaped(std::string_view text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      case '\'':
        result += "&#39;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

/// Outside code: a backslash before what GitHub's Markdown would read; a line break becomes a blank. An
/// underscore inside a word stays bare, as Markdown reads it so and names of methods have them.
inline std::string markdown_escaped(std::string_view text) {
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
