// SPDX-License-Identifier: BSL-1.0
#include "refusal.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

fmt::format_context::iterator fmt::formatter<nysalt::program::number_in_message>::format(
    const nysalt::program::number_in_message& number, fmt::format_context& context) const {
  if (is_plain) return fmt::format_to(context.out(), "{:.12g}", number.value);
  return fmt::formatter<double>::format(number.value, context);
}

namespace nysalt::program {

namespace {

struct letter {
  std::size_t length;  // in bytes; 0 where there is none
  char32_t code;
};

/// The UTF-8 letter at a place: whole, of the shortest form, and no half of a pair of UTF-16.
letter letter_at(std::string_view text, std::size_t at) {
  constexpr std::array<char32_t, 5> least{0, 0, 0x80, 0x800, 0x10000};  // by length
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const std::size_t length = byte(at) < 0x80        ? 1
                             : byte(at) >> 5U == 6  ? 2
                             : byte(at) >> 4U == 14 ? 3
                             : byte(at) >> 3U == 30 ? 4
                                                    : 0;
  if (length == 0 || at + length > text.size()) return {0, 0};
  char32_t code = length == 1 ? byte(at) : byte(at) & (0x7FU >> length);
  for (std::size_t i = 1; i < length; ++i) {
    if (byte(at + i) >> 6U != 2) return {0, 0};
    code = code << 6U | (byte(at + i) & 0x3FU);
  }
  const bool is_half = code >= 0xD800 && code < 0xE000;
  if (code < least.at(length) || code > 0x10FFFF || is_half) return {0, 0};
  return {length, code};
}

}  // namespace

std::string of_letters(std::string_view text) {
  std::string result;
  for (std::size_t at = 0; at < text.size();) {
    const auto [length, code] = letter_at(text, at);
    const bool is_control = code < 0x20 || (code >= 0x7F && code < 0xA0);
    result += length == 0 ? "?" : is_control ? " " : text.substr(at, length);
    at += std::max<std::size_t>(length, 1);
  }
  return result;
}

std::string without_nul(std::string text) {
  std::ranges::replace(text, '\0', ' ');
  return text;
}

}  // namespace nysalt::program
