// SPDX-License-Identifier: BSL-1.0
#include "program.hpp"

#include <sys/wait.h>

#include <cstdlib>

namespace nysalt::test {

finished shell(const scratch& folder, const std::string& line, int limit) {
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

finished run(const scratch& folder, const std::string& arguments) {
  return shell(folder, "\"$nysalt\" " + arguments);
}

finished run(const std::string& arguments) { return run(scratch("program"), arguments); }

nlohmann::ordered_json json_of(const finished& done) {
  return nlohmann::ordered_json::parse(done.out, nullptr, false);
}

nlohmann::ordered_json recorded(const std::filesystem::path& file) {
  const auto all =
      nlohmann::ordered_json::parse(contents(file.parent_path() / "manifest.json"), nullptr, false);
  return all.is_object() ? all.value("files", nlohmann::ordered_json())
                               .value(file.filename().string(), nlohmann::ordered_json())
                         : nlohmann::ordered_json();
}

}  // namespace nysalt::test
