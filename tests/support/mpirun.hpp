// SPDX-License-Identifier: BSL-1.0
// The program on several ranks, as a shell runs it.
#pragma once

#include <string>

namespace nysalt::test {

/// What goes before a command so that n processes run it; they may be more than the cores, and root's.
inline std::string on_ranks(int n) {
  std::string text = "OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 '" NYSALT_MPIRUN "'";
  text += " --oversubscribe --bind-to none -n " + std::to_string(n) + " ";
  return text;
}

}  // namespace nysalt::test
