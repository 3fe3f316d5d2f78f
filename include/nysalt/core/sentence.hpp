// SPDX-License-Identifier: BSL-1.0
// Puts words and numbers into a sentence. What steps says what is wrong by this, and needs no library for it.
#pragma once

#include <array>
#include <charconv>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <string>
#include <string_view>
#include <type_traits>

namespace nysalt {

/// The types of arguments of a sentence: text, a character, an integer, true or false, a double.
template <class T>
concept Piece =
    std::convertible_to<const T&, std::string_view> || std::integral<T> || std::same_as<T, double>;

namespace detail {
/// Text with a hole {} for each piece. Text with more or fewer, or with another brace, does not compile.
template <class... Pieces>
struct pattern {
  std::string_view text;

  consteval pattern(const char* literal) : text(literal) {  // NOLINT(google-explicit-constructor)
    std::size_t holes = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
      if (text[i] == '}') throw "a } without its {";
      if (text[i] != '{') continue;
      if (text.substr(i, 2) != "{}") throw "a hole is {}, without a format";
      ++i;
      ++holes;
    }
    if (holes != sizeof...(Pieces)) throw "there must be as many pieces as holes";
  }
};

inline void write_piece(std::string& sentence, std::string_view text) { sentence += text; }

inline void write_piece(std::string& sentence, std::integral auto x) {
  if constexpr (std::is_same_v<decltype(x), char>) {
    sentence += x;
  } else if constexpr (std::is_same_v<decltype(x), bool>) {
    sentence += x ? "true" : "false";
  } else {
    std::array<char, 20> digits;  // -2^63 and 2^64 - 1 take 20
    sentence.append(digits.data(), std::to_chars(digits.begin(), digits.end(), x).ptr);
  }
}

/// The fewest digits from which x is read back. With an exponent from 1e16 on, and below 1e-4.
inline void write_piece(std::string& sentence, std::same_as<double> auto x) {
  const double size = std::abs(x);
  const bool is_plain = (1e-4 <= size && size < 1e16) || size == 0.0 || !std::isfinite(x);
  std::array<char, 24> digits;  // -2.2250738585072014e-308 takes 24, -0.00012345678901234567 takes 23
  const auto format = is_plain ? std::chars_format::fixed : std::chars_format::scientific;
  sentence.append(digits.data(), std::to_chars(digits.begin(), digits.end(), x, format).ptr);
}

inline void write_up_to_hole(std::string& sentence, std::string_view& rest) {
  const auto hole = rest.find('{');
  sentence += rest.substr(0, hole);
  rest.remove_prefix(hole + 2);
}
}  // namespace detail

/// The pattern with the pieces in place of its {}, in order: sentence("{} of {}", 1, 2.5) is "1 of 2.5".
template <Piece... Pieces>
std::string sentence(detail::pattern<std::type_identity_t<Pieces>...> pattern, const Pieces&... pieces) {
  std::string result;
  std::string_view rest = pattern.text;
  ((detail::write_up_to_hole(result, rest), detail::write_piece(result, pieces)), ...);
  return result += rest;
}

// Numbers that are read, not computed with.

namespace detail {

/// The number x in decimal, rounded to `digits` significant digits, without the zeros at its end: 0.125 to
/// two is "0.12". With an exponent where it is shorter, as printf's %g has it.
std::string in_digits(double x, int digits);

}  // namespace detail

}  // namespace nysalt
