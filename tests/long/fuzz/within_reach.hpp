// SPDX-License-Identifier: BSL-1.0
// What a mutated wish may cost: the program does what it is asked for, if it takes a year.
#pragma once

#include <charconv>
#include <cmath>
#include <string>
#include <string_view>

namespace nysalt::fuzz {

/// Whether the number asks for little, or is so extreme that it must be refused: quotients of two of the
/// extremes are few steps, or more than can be counted.
inline bool is_within_reach(double value) {
  const double size = std::abs(value);
  const bool is_little = size == 0.0 || (size >= 0.01 && size <= 16.0);
  const bool is_past_counting = size >= 0x1p63 && size <= 0x1p65;
  return is_little || is_past_counting || !(size < 1e307) || (size >= 1e-308 && size <= 1e-307);
}

/// Numbers between small and extreme become moderate ones, and paths names in the current folder.
inline std::string within_reach(std::string text) {
  for (char& c : text) {
    if (c == '/') c = '_';
  }
  const auto belongs = [](char c) { return (c >= '0' && c <= '9') || c == '.'; };
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (!belongs(text[i])) continue;
    double value = 0.0;
    const char* const first = text.data() + i;
    const auto [end, error] = std::from_chars(first, text.data() + text.size(), value);
    std::size_t length = static_cast<std::size_t>(end - first);
    const bool is_number = error == std::errc{};
    if (is_number && !is_within_reach(value)) {
      const std::string_view moderate = value > 1.0 ? "3" : "0.05";
      text.replace(i, length, moderate);
      length = moderate.size();
    }
    i += length;
    while (i < text.size() && belongs(text[i])) ++i;  // no part of a number is another
  }
  return text;
}

}  // namespace nysalt::fuzz
