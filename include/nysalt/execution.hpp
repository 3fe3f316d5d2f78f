// SPDX-License-Identifier: BSL-1.0
// Threads, ranks and progress of a computation.
#pragma once

#include "nysalt/communicator.hpp"

namespace nysalt {

/// How a computation is done, which changes no bit of its result: a member of all options. What defines the
/// result, as a seed does, is a field of the options. Where only the number of threads is used, the options
/// say so, and ranks and progress are ignored.
struct execution {
  int threads = 1;                        ///< largest number of threads at a time, at least 1
  const communicator* ranks = &one_rank;  ///< ranks that share the work; must outlive it
  progress_callback progress = {};        ///< called after parts of the work; none: it is not reported
};

}  // namespace nysalt
