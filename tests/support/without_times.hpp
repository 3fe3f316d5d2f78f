// SPDX-License-Identifier: BSL-1.0
// What equal runs of the program have in common: every byte but those of measured times, and of memory.
#pragma once

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace nysalt::test {

/// The advice of a recommendation says by how much seconds differ.
inline bool is_measured_anew(std::string_view name) {
  return name.find("seconds") != std::string_view::npos || name == "peak_memory" || name == "advice";
}

inline void erase_times(nlohmann::ordered_json& document) {
  if (document.is_object()) {
    std::vector<std::string> times;
    for (const auto& [name, value] : document.items()) {
      if (is_measured_anew(name)) times.push_back(name);
    }
    for (const auto& name : times) document.erase(name);
  }
  if (!document.is_structured()) return;
  for (auto& member : document) erase_times(member);
}

/// A document as the program prints it, without the members that are times; a text that is none stays.
inline std::string without_times(const std::string& text) {
  auto document = nlohmann::ordered_json::parse(text, nullptr, false);
  if (document.is_discarded()) return text;
  erase_times(document);
  return document.dump(2);
}

/// A table without the columns that are times; there is no comma before the last of them but between cells.
inline std::string without_times_in_csv(const std::string& text) {
  std::istringstream lines(text);
  std::vector<bool> keeps;
  std::string rest;
  for (std::string line; std::getline(lines, line); rest += '\n') {
    std::istringstream cells(line);
    std::size_t column = 0;
    for (std::string cell; std::getline(cells, cell, ','); ++column) {
      if (rest.empty() || rest.find('\n') == std::string::npos) keeps.push_back(!is_measured_anew(cell));
      if (column >= keeps.size() || keeps[column]) rest += cell + ',';
    }
  }
  return rest;
}

}  // namespace nysalt::test
