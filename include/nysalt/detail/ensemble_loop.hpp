// SPDX-License-Identifier: BSL-1.0
// Loops over trajectories and over blocks of them, on several threads.
#pragma once

#include <cstdint>
#include <functional>

namespace nysalt {

/// Calls body(first, n) once for each block of n <= width consecutive trajectories first .. first + n - 1, of
/// `count` in all, on at most `threads` threads at a time, in no certain order; only the last block is
/// shorter. A body writes what it finds into the places of its trajectories; a sum over them is then taken by
/// tree_sum, and neither width nor the number of threads changes a bit. With one thread the order is that of
/// the trajectories, and no thread is made. `progress`, if given, is called after each block with the number
/// of trajectories done; from any thread, never two calls at once.
///
/// If a body throws, its trajectories are run again, one after the other, so that what leaves the
/// loop is the exception of the first trajectory that has one, for any width and threads; some beyond it are
/// not visited. Each body begins with rounding to nearest and with subnormal numbers kept, whatever the
/// thread has. Throws std::invalid_argument if threads or width are below 1, or if a body changes that.
void for_each_block(std::int64_t count, int width, int threads,
                    const std::function<void(std::int64_t, int)>& body,
                    const std::function<void(std::int64_t)>& progress = {});

/// Calls body(m) for m = 0 .. count - 1: blocks of one.
void for_each_trajectory(std::int64_t count, int threads, const std::function<void(std::int64_t)>& body,
                         const std::function<void(std::int64_t)>& progress = {});

}  // namespace nysalt
