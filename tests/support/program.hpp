// SPDX-License-Identifier: BSL-1.0
// The program `nysalt` (NYSALT_PROGRAM) as a shell runs it.
#pragma once

#include <sys/wait.h>

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>

#include "scratch.hpp"

namespace nysalt::test {

struct finished {
  int code;  // 124 if it hung
  std::string out;
  std::string err;
};

/// One line of the shell in the folder, where "$nysalt" is the program, with no input and a time limit in
/// seconds that only a program which hangs can reach.
inline finished shell(const scratch& folder, const std::string& line, int limit = 60) {
  const scratch streams(folder.path().filename().string() + "_streams");
  const std::string out = streams / "out";
  const std::string err = streams / "err";
  std::string whole = "cd '" + folder.path().string();
  whole += "' && export nysalt='" NYSALT_PROGRAM "' && { ";
  whole += line + "\n} </dev/null >'";
  whole += out + "' 2>'";
  whole += err + "'";
  setenv("NYSALT_TEST_LINE", whole.c_str(), 1);  // so that no quote has to be quoted
  const std::string command = "exec timeout " + std::to_string(limit) + " sh -c \"$NYSALT_TEST_LINE\"";
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, contents(out), contents(err)};
}

/// `nysalt arguments` in the folder.
inline finished run(const scratch& folder, const std::string& arguments) {
  return shell(folder, "\"$nysalt\" " + arguments);
}

/// `nysalt arguments` in a folder of its own.
inline finished run(const std::string& arguments) { return run(scratch("program"), arguments); }

/// The one document that a run printed; discarded (is_discarded()) if it is none.
inline nlohmann::ordered_json json_of(const finished& done) {
  return nlohmann::ordered_json::parse(done.out, nullptr, false);
}

}  // namespace nysalt::test
