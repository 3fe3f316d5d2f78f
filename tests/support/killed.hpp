// SPDX-License-Identifier: BSL-1.0
// A run that is killed in the midst of it.
#pragma once

#include <string>

#include "program.hpp"

namespace nysalt::test {

/// Lines of a shell that wait, while process $pid lives, until a checkpoint tells of `step`, or of finished
/// trajectories.
inline std::string wait_for(const std::string& checkpoint, int step) {
  std::string lines = "while kill -0 $pid 2>/dev/null; do n=\"$(head -n 1 " + checkpoint;
  lines += R"x( 2>/dev/null | sed -n 's/.*"first":[0-9]*,"step":\([0-9]*\).*/\1/p')"; [ "${n:-0}" -ge )x";
  lines += std::to_string(step) + " ] && break; sleep .01; done\n";
  return lines;
}

/// Kills `nysalt line` without warning once its checkpoint tells of `step`; whether it was still running
/// then.
inline bool killed_at(const scratch& folder, const std::string& line, const std::string& checkpoint,
                      int step) {
  std::string lines = "\"$nysalt\" " + line + " >/dev/null 2>&1 & pid=$!\n";
  lines += wait_for(checkpoint, step);
  return shell(folder, lines + "kill -9 $pid && ! wait $pid").code == 0;
}

}  // namespace nysalt::test
