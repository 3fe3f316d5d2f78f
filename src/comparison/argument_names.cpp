// SPDX-License-Identifier: BSL-1.0
#include "argument_names.hpp"

#include <algorithm>
#include <cctype>

namespace nysalt::program {

namespace {

bool is_letter(char c) { return std::islower(static_cast<unsigned char>(c)) != 0; }

/// The length of the option that begins at a place; 0 if none does.
std::size_t option_at(const std::string& text, std::size_t at) {
  if (text.compare(at, 2, "--") != 0 || at + 2 >= text.size() || !is_letter(text[at + 2])) return 0;
  std::size_t end = at + 2;
  while (end < text.size() &&
         (is_letter(text[end]) || (text[end] == '-' && end + 1 < text.size() && is_letter(text[end + 1])))) {
    ++end;
  }
  return end - at;
}

}  // namespace

std::string with_arguments(const std::string& text, const argument_spelling& spelling) {
  const std::size_t proposal = text.find("nysalt learn --");
  const std::string learning = "learn_";
  std::string result;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = at > proposal ? 0 : option_at(text, at);
    if (length == 0) {
      result += text[at++];
      continue;
    }
    std::string name = text.substr(at + 2, length - 2);
    std::ranges::replace(name, '-', '_');
    at += length;
    if (name == "for") name = "purpose";
    const bool is_flag = name == "force" || name == "equal_cost" || name == "reversible";
    if (name.starts_with(learning)) name.replace(0, learning.size(), spelling.learning);
    result += name;
    if (is_flag) result += spelling.yes;
  }
  return result;
}

}  // namespace nysalt::program
