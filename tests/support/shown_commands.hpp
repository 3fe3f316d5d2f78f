// SPDX-License-Identifier: BSL-1.0
// The command lines of the program that a page shows.
#pragma once

#include <sstream>
#include <string>
#include <vector>

namespace nysalt::test {

inline std::vector<std::string> lines_of(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// What follows a mark at the beginning of a line.
inline std::vector<std::string> behind(const std::string& mark, const std::vector<std::string>& lines) {
  std::vector<std::string> found;
  for (const auto& line : lines) {
    if (line.starts_with(mark)) found.push_back(line.substr(mark.size()));
  }
  return found;
}

/// The lines of all ```sh blocks; one that ends with a backslash goes on in the next.
inline std::vector<std::string> shell_lines(const std::string& markdown) {
  std::vector<std::string> found;
  bool inside = false;
  bool goes_on = false;
  for (auto line : lines_of(markdown)) {
    if (line.starts_with("```")) {
      inside = !inside && line == "```sh";
      goes_on = false;
      continue;
    }
    if (!inside) continue;
    const bool unfinished = line.ends_with('\\');
    if (unfinished) line.pop_back();
    if (goes_on) {
      found.back() += line;
    } else {
      found.push_back(line);
    }
    goes_on = unfinished;
  }
  return found;
}

/// What a page calls the program with.
inline std::vector<std::string> commands_of(const std::string& markdown) {
  std::vector<std::string> commands;
  for (const auto& line : shell_lines(markdown)) {
    for (const char* program : {"nysalt ", "build/release/nysalt "}) {
      for (const auto& arguments : behind(program, {line})) commands.push_back(arguments);
    }
  }
  return commands;
}

}  // namespace nysalt::test
