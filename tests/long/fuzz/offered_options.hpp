// SPDX-License-Identifier: BSL-1.0
// The options of all commands, and what a mutated wish may cost: the program does what it is asked for, if it
// takes a year.
#pragma once

#include <charconv>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "program/options/shared_options.hpp"
#include "program/options/subcommand.hpp"
#include "program/parse.hpp"

namespace nysalt::fuzz {

/// The program offers them, which takes longer than reading a line, at each start.
class offered_options {
 public:
  offered_options() {
    program::add_of_program(app_);
    commands_ = program::offer_all(app_, common_);
  }

  /// Reads a line of options, without the name of the program, and runs no command. Throws refusal.
  void read(std::vector<std::string> words) {
    words.insert(words.begin(), app_.get_name());
    std::vector<char*> pointers;
    for (auto& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    program::parse(app_, static_cast<int>(pointers.size()) - 1, pointers.data());
  }

 private:
  program::common_settings common_;
  CLI::App app_{"", "nysalt"};
  std::vector<program::subcommand> commands_;  // which own what the options are read into
};

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
