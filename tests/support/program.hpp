// SPDX-License-Identifier: BSL-1.0
// The program `nysalt`, or `nysalt_paper` in tests/long/paper (NYSALT_PROGRAM), as a shell runs it: what it
// prints, what equal runs have in common, and what it must refuse.
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

/// What "$nysalt" is: NYSALT_PROGRAM, unless a test takes a copy of it.
std::string& program();

/// One line of the shell in the folder, where "$nysalt" is program(), with no input and a time limit in
/// seconds that only a program which hangs can reach.
finished shell(const scratch& folder, const std::string& line, int limit = 600);

/// `nysalt arguments` in the folder.
finished run(const scratch& folder, const std::string& arguments);

/// `nysalt arguments` in a folder of its own.
finished run(const std::string& arguments);

/// The one document that a run printed; discarded (is_discarded()) if it is none.
nlohmann::ordered_json json_of(const finished& done);

/// What the manifest of a folder records of a file; null if nothing.
nlohmann::ordered_json recorded(const std::filesystem::path& file);

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
  return name.find("seconds") != std::string_view::npos || name == "peak_memory" || name == "advice";
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

/// A command line that must be refused: exit code 2, one line that says why, nothing printed or written.
struct bad {
  std::string arguments;
  std::vector<std::string_view> words;  // that must be said
};

inline bool is_one_line(const std::string& text) {
  return std::count(text.begin(), text.end(), '\n') == 1 && text.ends_with('\n') &&
         std::none_of(text.begin(), text.end() - 1, [](unsigned char c) { return c < ' '; });
}

/// All must be refused, in one folder that stays as it is.
inline void all_refused(const scratch& folder, const std::vector<bad>& cases) {
  const auto before = folder.files();
  for (const auto& [arguments, words] : cases) {
    const finished done = run(folder, arguments);
    BOOST_TEST_CONTEXT("nysalt " << arguments << "\nsaid: " << done.err) {
      BOOST_TEST(done.code == 2);
      BOOST_TEST(done.out == "");
      BOOST_TEST(is_one_line(done.err));
      BOOST_TEST(done.err.starts_with("nysalt: "));
      for (const auto word : words) {
        BOOST_TEST(done.err.find(word) != std::string::npos, "missing: " << word);
      }
      BOOST_TEST((folder.files() == before));
    }
  }
}

/// While it lives, "$nysalt" is a copy of the program that compiles plug-ins without optimisation: beside it
/// lie other flags.
class unoptimised_plugins {
 public:
  unoptimised_plugins() : folder_("unoptimised") {
    const std::filesystem::path whole = NYSALT_PROGRAM;
    std::filesystem::copy_file(whole, folder_ / "nysalt", std::filesystem::copy_options::overwrite_existing);
    std::ifstream flags(whole.parent_path() / "plugin.flags");
    std::ofstream ours(folder_ / "plugin.flags");
    for (std::string flag; std::getline(flags, flag);)
      ours << (flag.starts_with("-O") ? "-O0" : flag) << '\n';
    program() = folder_ / "nysalt";
  }
  unoptimised_plugins(const unoptimised_plugins&) = delete;
  unoptimised_plugins& operator=(const unoptimised_plugins&) = delete;
  ~unoptimised_plugins() { program() = NYSALT_PROGRAM; }

 private:
  scratch folder_;
};

}  // namespace nysalt::test
