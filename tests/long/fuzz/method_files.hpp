// SPDX-License-Identifier: BSL-1.0
// The readers of a method file.
#pragma once

#include <string>

#include "comparison/method_file.hpp"
#include "program_run.hpp"

namespace nysalt::fuzz {

/// The reader of all texts; commands, which take a hundred times as long, of some, and `compare` of few.
/// Asked for with --force, so that a file for another step or system goes further.
inline void try_method_file(const std::string& text) {
  const bool is_taken = takes([&] { program::method_file_in(text, "method.json"); });
  if (!is_one_in(is_taken ? 16 : 256, text)) return;
  const input_file file{"method.json", text};
  const std::string step = "0.02";
  run({"stability", "--method", file.name, "--json"}, {file});
  run({"run", "--method", file.name, "--step", step, "--horizon", "0.06", "--threads", "1", "--force",
       "--output", "out.csv"},
      {file});
  if (!is_one_in(1024, text)) return;
  run({"compare", "--methods", "verlet," + file.name, "--steps", step, "--trajectories", "2", "--horizon",
       "0.06", "--fine-step", "0.01", "--threads", "1", "--force", "--json"},
      {file});
}

}  // namespace nysalt::fuzz
