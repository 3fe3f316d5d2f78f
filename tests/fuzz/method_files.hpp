// SPDX-License-Identifier: BSL-1.0
// The readers of a method file.
#pragma once

#include <string>

#include "program_run.hpp"

namespace nysalt::fuzz {

/// Asked for with --force, so that a file for another step or system goes further. `compare`, which times its
/// methods, is dear: one text in 64.
inline void try_method_file(const std::string& text) {
  const input_file file{"method.json", text};
  const std::string step = "0.02";
  run({"stability", "--method", file.name, "--json"}, {file});
  run({"run", "--method", file.name, "--step", step, "--horizon", "0.06", "--threads", "1", "--force",
       "--output", "out.csv"},
      {file});
  if (text.size() % 64 != 0) return;
  run({"compare", "--methods", "verlet," + file.name, "--steps", step, "--trajectories", "2", "--horizon",
       "0.06", "--fine-step", "0.01", "--threads", "1", "--force", "--json"},
      {file});
}

}  // namespace nysalt::fuzz
