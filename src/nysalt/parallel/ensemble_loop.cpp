// SPDX-License-Identifier: BSL-1.0

#include "nysalt/parallel/ensemble_loop.hpp"

#include <fmt/format.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>
#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <stdexcept>

#include "nysalt/core/rounding.hpp"
#include "with_threads.hpp"

namespace nysalt {

void detail::for_each_block(std::int64_t count, int width, const execution& how,
                            const std::function<void(std::int64_t, int)>& body) {
  const int threads = how.threads;
  const progress_callback& progress = how.progress;
  if (threads < 1) throw std::invalid_argument(fmt::format("threads must be at least one, got {}", threads));
  if (width < 1)
    throw std::invalid_argument(fmt::format("lanes of a block must be at least one, got {}", width));
  const std::int64_t blocks = count / width + (count % width != 0 ? 1 : 0);
  const auto size_of = [&](std::int64_t block) {
    return static_cast<int>(std::min<std::int64_t>(width, count - block * width));
  };
  const auto go_through = [&](std::int64_t block) {
    const int size = size_of(block);
    const auto rounded_as_usual = [&](std::int64_t first, int trajectories) {
      const detail::usual_rounding rounding;
      body(first, trajectories);
      rounding.require();
    };
    try {
      rounded_as_usual(block * width, size);
    } catch (...) {
      for (int k = 0; size > 1 && k < size; ++k) rounded_as_usual(block * width + k, 1);
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
  detail::with_threads(threads, [&] {
    using oneapi::tbb::global_control;
    // As many as were asked for, also beyond the number of cores.
    const global_control allowed(global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
    oneapi::tbb::task_arena arena(threads);
    arena.execute([&] { oneapi::tbb::parallel_for(std::int64_t{0}, blocks, guarded); });
  });
  if (thrown) std::rethrow_exception(thrown);
}

void for_each_trajectory(std::int64_t count, const execution& how,
                         const std::function<void(std::int64_t)>& body) {
  detail::for_each_block(count, 1, how, [&](std::int64_t m, int) { body(m); });
}

}  // namespace nysalt
