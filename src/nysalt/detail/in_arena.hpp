// SPDX-License-Identifier: BSL-1.0
// Work on the threads of an arena of oneTBB.
#pragma once

#include <oneapi/tbb/task_arena.h>

#include <stdexcept>
#include <string_view>

#include "nysalt/detail/sentence.hpp"

namespace nysalt::detail {

/// Runs work() in an arena of `threads` threads. Throws std::runtime_error if the system starts fewer, and
/// what work() throws.
void in_arena(oneapi::tbb::task_arena& arena, int threads, const auto& work) {
  try {
    arena.execute(work);
  } catch (const std::runtime_error& problem) {
    if (!std::string_view(problem.what()).starts_with("pthread_create")) throw;  // what oneTBB says
    throw std::runtime_error(sentence("threads must be as many as the system starts, got {} ({}); take fewer",
                                      threads, problem.what()));
  }
}

}  // namespace nysalt::detail
