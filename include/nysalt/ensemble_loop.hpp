// SPDX-License-Identifier: BSL-1.0
// The loop over trajectories, on several threads.
#pragma once

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>
#include <stdexcept>

#include <fmt/format.h>

namespace nysalt {

/// Calls body(m) once for m = 0 .. count - 1, on at most `threads` threads at a time, in no certain order.
/// A body writes what it finds into the place of its m; whoever sums then takes tree_sum, and the number of
/// threads changes no bit. With one thread the order is 0, 1, ... and no thread is made.
/// `progress`, if given, is told after each how many are done; from any thread, never two calls at once.
/// If bodies throw, the exception of the smallest m leaves the loop, and some m beyond it are not visited.
/// Throws std::invalid_argument if threads < 1.
template <class Body>
void for_each_trajectory(std::int64_t count, int threads, const Body& body,
                         const std::function<void(std::int64_t)>& progress = {}) {
  if (threads < 1) throw std::invalid_argument(fmt::format("at least one thread is needed, got {}", threads));
  if (threads == 1) {
    for (std::int64_t m = 0; m < count; ++m) {
      body(m);
      if (progress) progress(m + 1);
    }
    return;
  }
  std::atomic<std::int64_t> smallest = count;
  std::exception_ptr thrown;
  std::mutex guard;
  std::int64_t done = 0;
  const auto guarded = [&](std::int64_t m) {
    if (m > smallest) return;  // only what comes before can still change the outcome
    try {
      body(m);
      const std::lock_guard lock(guard);
      ++done;
      if (progress) progress(done);
    } catch (...) {
      const std::lock_guard lock(guard);
      if (m > smallest) return;
      smallest = m;
      thrown = std::current_exception();
    }
  };
  using oneapi::tbb::global_control;
  // As many as were asked for, also beyond the number of cores.
  const global_control allowed(global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  oneapi::tbb::task_arena arena(threads);
  arena.execute([&] { oneapi::tbb::parallel_for(std::int64_t{0}, count, guarded); });
  if (thrown) std::rethrow_exception(thrown);
}

}  // namespace nysalt
