// SPDX-License-Identifier: BSL-1.0
// What equal runs of the program have in common: every byte but those of measured times.
#pragma once

#include <algorithm>
#include <array>
#include <sstream>
#include <string>

namespace nysalt::test {

/// A document as the program prints it, one member a line, without the members that are times.
inline std::string without_times(const std::string& document) {
  const std::array<std::string, 4> times{"seconds", "seconds_per_time", "data_seconds", "fit_seconds"};
  std::istringstream lines(document);
  std::string rest;
  for (std::string line; std::getline(lines, line);) {
    const bool is_time = std::any_of(times.begin(), times.end(), [&](const auto& key) {
      return line.find('"' + key + "\": ") != std::string::npos;
    });
    if (!is_time) rest += line + '\n';
  }
  return rest;
}

}  // namespace nysalt::test
