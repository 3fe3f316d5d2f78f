// SPDX-License-Identifier: BSL-1.0
// The program `nysalt` (NYSALT_PROGRAM), as a shell runs it: what it prints, what equal runs have in common,
// and what it must refuse.
#pragma once

#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "scratch.hpp"

namespace nysalt::test {

struct finished {
  int code;  // 124 if it hung
  std::string out;
  std::string err;
};

/// One line of the shell in the folder, where "$nysalt" is NYSALT_PROGRAM, with no input and a time limit in
/// seconds that only a program which hangs can reach.
finished shell(const scratch& folder, const std::string& line, int limit = 600);

/// `nysalt arguments` in the folder.
finished run(const scratch& folder, const std::string& arguments);

/// `nysalt arguments` in a folder of its own.
finished run(const std::string& arguments);

/// The one document that a run printed; discarded (is_discarded()) if it is none.
nlohmann::ordered_json json_of(const finished& done);

/// What `nysalt arguments --json` printed; it must have ended well, and have said nothing else.
inline nlohmann::ordered_json document(const std::string& arguments,
                                       const scratch& folder = scratch("document")) {
  const auto done = run(folder, arguments + " --json");
  BOOST_TEST(done.code == 0, "nysalt " << arguments);
  BOOST_TEST(done.err == "", "nysalt " << arguments << " said " << done.err);
  auto result = json_of(done);
  BOOST_REQUIRE(result.is_object());
  return result;
}

// What equal runs of the program have in common: every byte but those of measured times, and of memory.

/// The advice of a recommendation says by how much seconds differ.
inline bool is_measured_anew(std::string_view name) {
  return name.find("seconds") != std::string_view::npos || name == "peak_memory" || name == "advice" ||
         name == "provenance";
}

inline void erase_times(nlohmann::ordered_json& document) {
  if (!document.is_structured()) return;
  for (auto member = document.begin(); member != document.end();) {
    if (document.is_object() && is_measured_anew(member.key())) {
      member = document.erase(member);
    } else {
      erase_times(*member++);
    }
  }
}

/// A document as the program prints it, without the members that are times and its provenance; a text that is
/// none stays, but for a first line that says how a table was made.
inline std::string without_times(const std::string& text) {
  auto document = nlohmann::ordered_json::parse(text, nullptr, false);
  if (document.is_discarded()) return text.starts_with("# nysalt ") ? text.substr(text.find('\n') + 1) : text;
  erase_times(document);
  return document.dump(2);
}

/// A table without what it says of itself and the columns that are times; there is no comma before the last
/// of them but between cells.
inline std::string without_times_in_csv(const std::string& text) {
  std::istringstream lines(text.starts_with("# nysalt ") ? text.substr(text.find('\n') + 1) : text);
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

inline bool is_one_line(const std::string& text) {
  return std::count(text.begin(), text.end(), '\n') == 1 && text.ends_with('\n') &&
         std::none_of(text.begin(), text.end() - 1, [](unsigned char c) { return c < ' '; });
}

}  // namespace nysalt::test
