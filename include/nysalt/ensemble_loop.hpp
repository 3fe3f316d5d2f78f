// SPDX-License-Identifier: BSL-1.0
// The loop over trajectories, on several threads.
#pragma once

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>
#include <stdexcept>

#include <fmt/format.h>

namespace nysalt {

/// Calls body(first, n) once for each block of n <= width consecutive trajectories first .. first + n - 1, of
/// `count` in all, on at most `threads` threads at a time, in no certain order; only the last block is
/// shorter. A body writes what it finds into the places of its trajectories; whoever sums then takes
/// tree_sum, and neither width nor the number of threads changes a bit. With one thread the order is that of
/// the trajectories, and no thread is made. `progress`, if given, is told after each block how many are done;
/// from any thread, never two calls at once.
///
/// If a body throws, its trajectories are gone through again, one after the other, so that what leaves the
/// loop is the exception of the first trajectory that has one, whatever width and threads; some beyond it are
/// not visited. Throws std::invalid_argument if threads or width are below 1.
template <class Body>
void for_each_block(std::int64_t count, int width, int threads, const Body& body,
                    const std::function<void(std::int64_t)>& progress = {}) {
  if (threads < 1) throw std::invalid_argument(fmt::format("at least one thread is needed, got {}", threads));
  if (width < 1) throw std::invalid_argument(fmt::format("a block has at least one lane, got {}", width));
  const std::int64_t blocks = count / width + (count % width != 0 ? 1 : 0);
  const auto size_of = [&](std::int64_t block) {
    return static_cast<int>(std::min<std::int64_t>(width, count - block * width));
  };
  const auto go_through = [&](std::int64_t block) {
    const int size = size_of(block);
    try {
      body(block * width, size);
    } catch (...) {
      for (int k = 0; size > 1 && k < size; ++k) body(block * width + k, 1);
      throw;
    }
  };
  if (threads == 1) {
    for (std::int64_t block = 0; block < blocks; ++block) {
      go_through(block);
      if (progress) progress(block * width + size_of(block));
    }
    return;
  }
  std::atomic<std::int64_t> smallest = blocks;
  std::exception_ptr thrown;
  std::mutex guard;
  std::int64_t done = 0;
  const auto guarded = [&](std::int64_t block) {
    if (block > smallest) return;  // only what comes before can still change the outcome
    try {
      go_through(block);
      if (!progress) return;
      const std::lock_guard lock(guard);
      done += size_of(block);
      progress(done);
    } catch (...) {
      const std::lock_guard lock(guard);
      if (block > smallest) return;
      smallest = block;
      thrown = std::current_exception();
    }
  };
  using oneapi::tbb::global_control;
  // As many as were asked for, also beyond the number of cores.
  const global_control allowed(global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  oneapi::tbb::task_arena arena(threads);
  arena.execute([&] { oneapi::tbb::parallel_for(std::int64_t{0}, blocks, guarded); });
  if (thrown) std::rethrow_exception(thrown);
}

/// Calls body(m) for m = 0 .. count - 1: blocks of one.
template <class Body>
void for_each_trajectory(std::int64_t count, int threads, const Body& body,
                         const std::function<void(std::int64_t)>& progress = {}) {
  for_each_block(
      count, 1, threads, [&](std::int64_t m, int) { body(m); }, progress);
}

}  // namespace nysalt
