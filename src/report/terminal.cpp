// SPDX-License-Identifier: BSL-1.0
#include "terminal.hpp"

#include <algorithm>
#include <sstream>

namespace nysalt {

std::size_t columns_of(std::string_view text) {
  const auto begins = [](char c) { return (static_cast<unsigned char>(c) & 0xc0U) != 0x80U; };
  return static_cast<std::size_t>(std::ranges::count_if(text, begins));
}

std::string wrapped(std::string_view text, std::size_t width) {
  std::string result;
  std::istringstream lines{std::string(text)};
  for (std::string line; std::getline(lines, line);) {
    if (columns_of(line) <= width) {
      result += line + '\n';
      continue;
    }
    const std::size_t indent = std::min(line.find_first_not_of(' '), line.size());
    std::string now(indent, ' ');
    bool is_begun = false;
    std::istringstream words(line);
    for (std::string word; words >> word;) {
      if (is_begun && columns_of(now) + 1 + columns_of(word) > width) {
        result += now + '\n';
        now.assign(indent + 2, ' ');
        is_begun = false;
      }
      now += (is_begun ? " " : "") + word;
      is_begun = true;
    }
    result += now + '\n';
  }
  return result;
}

std::string wrapped_plainly(std::string text, std::size_t width) {
  std::erase(text, '`');
  return wrapped(text, width);
}

}  // namespace nysalt
