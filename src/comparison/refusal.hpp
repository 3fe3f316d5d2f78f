// SPDX-License-Identifier: BSL-1.0
// Bad input, refused in one line.
#pragma once

#include <fmt/format.h>

#include <concepts>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include "spelling.hpp"

namespace nysalt::program {

/// A number in a message: of twelve digits where no format is given, so that 0.6 reads so where arithmetic
/// has made it 0.6000000000000001.
struct number_in_message {
  double value;
};

}  // namespace nysalt::program

template <>
struct fmt::formatter<nysalt::program::number_in_message> : fmt::formatter<double> {
  constexpr auto parse(fmt::format_parse_context& context) {
    is_plain = context.begin() == context.end() || *context.begin() == '}';
    return fmt::formatter<double>::parse(context);
  }
  fmt::format_context::iterator format(const nysalt::program::number_in_message& number,
                                       fmt::format_context& context) const;

  bool is_plain = true;
};

namespace nysalt::program {

/// A text that may hold anything of a file, as a line shows it: controls are spaces, and bytes that are no
/// letter of UTF-8 are ?.
std::string of_letters(std::string_view text);

/// With spaces for NUL, at which what() of an exception would end.
std::string without_nul(std::string text);

/// An exception that says what is wrong, where, and what to do. The program ends with exit code 2.
class refusal : public std::runtime_error {
 public:
  explicit refusal(std::string text) : std::runtime_error(without_nul(std::move(text))) {}
};

template <class T>
  requires(!std::is_floating_point_v<T>)
const T& in_message(const T& value) {
  return value;
}
template <std::floating_point T>
number_in_message in_message(T value) {
  return {value};
}
template <class T>
using type_in_message = decltype(in_message(std::declval<const T&>()));

/// fmt::format, with numbers as above.
template <class... A>
std::string message(fmt::format_string<type_in_message<A>...> text, const A&... values) {
  return fmt::format(text, in_message(values)...);
}

template <class... A>
[[noreturn]] void refuse(fmt::format_string<type_in_message<A>...> text, const A&... values) {
  throw refusal(message(text, values...));
}

/// Refuses the value of a parameter: `text` is what follows the name.
template <class... A>
[[noreturn]] void refuse_value(std::string_view field, fmt::format_string<type_in_message<A>...> text,
                               const A&... values) {
  throw refusal(spelled(field) + " " + message(text, values...));
}

/// "a, b, c"
std::string listed(const auto& names) {
  std::string text;
  for (const auto& name : names) {
    if (!text.empty()) text += ", ";
    text += name;
  }
  return text;
}

}  // namespace nysalt::program
