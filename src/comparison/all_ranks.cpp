// SPDX-License-Identifier: BSL-1.0
#include "all_ranks.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <string>

namespace nysalt::program {

namespace {
const communicator* joined = &one_rank;
}

const communicator& all_ranks() { return *joined; }

void join(const communicator& ranks) { joined = &ranks; }

/// Ranks have pipes to mpirun, which passes on what they say.
bool has_terminal() {
  if (isatty(STDERR_FILENO) != 0) return true;
  if (all_ranks().is_single()) return false;
  const std::string of_parent = fmt::format("/proc/{}/fd/{}", getppid(), STDERR_FILENO);
  const int descriptor = open(of_parent.c_str(), O_WRONLY | O_NOCTTY | O_CLOEXEC);
  if (descriptor < 0) return false;
  const bool result = isatty(descriptor) != 0;
  close(descriptor);
  return result;
}

}  // namespace nysalt::program
