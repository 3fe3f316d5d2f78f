// SPDX-License-Identifier: BSL-1.0
// Files of options. What would make a run long stands on the command line, which wins.
#include <cstddef>
#include <cstdint>

#include "offered_options.hpp"
#include "program_run.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace nysalt::fuzz;
  static offered_options offered;
  const input_file file{"options.toml", within_reach({reinterpret_cast<const char*>(data), size})};
  const std::vector<std::string> of_stability{"--config", file.name, "stability"};
  const std::vector<std::string> of_run{"--config", file.name, "run", "--threads", "1"};
  const bool by_stability = takes([&] { offered.read(of_stability); }, {file});
  const bool by_run = takes([&] { offered.read(of_run); }, {file});
  if (!is_one_in(by_stability || by_run ? 64 : 1024, file.text))
    return 0;  // commands take many times as long
  run(of_stability, {file});
  run(of_run, {file});
  if (!is_one_in(16384, file.text)) return 0;  // and these still more
  run({"--config", file.name, "compare", "--threads", "1", "--trajectories", "2", "--learn-trajectories", "2",
       "--json"},
      {file});
  run({"--config", file.name, "learn", "--threads", "1", "--trajectories", "2", "--random-starts", "0"},
      {file});
  return 0;
}
