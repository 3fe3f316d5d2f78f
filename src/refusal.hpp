// SPDX-License-Identifier: BSL-1.0
// Bad input, told in one line.
#pragma once

#include <fmt/format.h>

#include <stdexcept>
#include <string>

namespace nysalt::program {

/// What is wrong, where, and what to do. The program ends with exit code 2.
class refusal : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

template <class... A>
[[noreturn]] void refuse(fmt::format_string<A...> text, A&&... values) {
  throw refusal(fmt::format(text, std::forward<A>(values)...));
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
