// SPDX-License-Identifier: BSL-1.0
// Work on threads of oneTBB, and threads that the system refuses.
#pragma once

#include <stdexcept>
#include <string_view>

namespace nysalt::detail {

/// Throws std::runtime_error unless the system starts `threads` - 1 threads beside this one. If it does not,
/// oneTBB, which starts threads from threads that it has started, throws where nothing catches, and the
/// process is aborted. Cost: these threads are started and ended, once in a process for each larger number.
void require_threads(int threads);

/// Throws std::runtime_error of threads that the system does not start; `reason` is that of the system.
[[noreturn]] void refuse_threads(int threads, std::string_view reason);

/// Calls work(), which makes and uses `threads` threads of oneTBB. Throws std::runtime_error if the system
/// starts fewer, and what work() throws.
void with_threads(int threads, const auto& work) {
  require_threads(threads);
  try {
    work();
  } catch (const std::runtime_error& problem) {  // others may have taken threads meanwhile
    if (!std::string_view(problem.what()).starts_with("pthread_create")) throw;  // what oneTBB says
    refuse_threads(threads, problem.what());
  }
}

}  // namespace nysalt::detail
