// SPDX-License-Identifier: BSL-1.0
// The program `nysalt`, or `nysalt_paper` in tests/long/paper (NYSALT_PROGRAM), as a shell runs it. In
// program.cpp, as reading JSON is long to compile.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

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

}  // namespace nysalt::test
