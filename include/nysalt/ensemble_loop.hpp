// SPDX-License-Identifier: BSL-1.0
// The loop over trajectories, on several threads.
#pragma once

#include <cstdint>
#include <functional>

#include "nysalt/ensemble_blocks.hpp"
#if !defined NYSALT_COMPILED_ONCE
#include "nysalt/ensemble_threads.hpp"
#endif

namespace nysalt {

/// Calls body(m) for m = 0 .. count - 1: blocks of one.
inline void for_each_trajectory(std::int64_t count, int threads,
                                const std::function<void(std::int64_t)>& body,
                                const std::function<void(std::int64_t)>& progress = {}) {
  for_each_block(
      count, 1, threads, [&](std::int64_t m, int) { body(m); }, progress);
}

}  // namespace nysalt
