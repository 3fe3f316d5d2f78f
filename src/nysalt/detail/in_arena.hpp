// SPDX-License-Identifier: BSL-1.0
// Work on the threads of an arena of oneTBB.
#pragma once

#include <oneapi/tbb/task_arena.h>

namespace nysalt::detail {

/// Throws std::runtime_error unless the system starts as many threads as this one and others make. oneTBB
/// starts a thread from another that it has started, where nothing catches the exception if the system
/// refuses, and the process is aborted. Cost: as many threads are started and ended when a process first
/// asks for so many.
void require_threads(int threads);

/// Runs work() in an arena of `threads` threads. Throws std::runtime_error if the system starts fewer, and
/// what work() throws.
void in_arena(oneapi::tbb::task_arena& arena, int threads, const auto& work) {
  require_threads(threads);
  arena.execute(work);
}

}  // namespace nysalt::detail
