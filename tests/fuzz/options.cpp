// SPDX-License-Identifier: BSL-1.0
// Files of options. What would make a run long stands on the command line, which wins.
#include <cstddef>
#include <cstdint>

#include "program_run.hpp"
#include "within_reach.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using nysalt::fuzz::run;
  const std::string text(reinterpret_cast<const char*>(data), size);
  const nysalt::fuzz::input_file file{"options.toml", nysalt::fuzz::within_reach(text)};
  run({"--config", file.name, "stability"}, {file});
  run({"--config", file.name, "run", "--threads", "1"}, {file});
  if (size % 64 != 0) return 0;  // these are dear
  run({"--config", file.name, "compare", "--threads", "1", "--trajectories", "2", "--learn-trajectories", "2",
       "--json"},
      {file});
  run({"--config", file.name, "learn", "--threads", "1", "--trajectories", "2", "--random-starts", "0"},
      {file});
  return 0;
}
