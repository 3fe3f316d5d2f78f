// SPDX-License-Identifier: BSL-1.0

#include "nysalt/detail/ensemble_loop.hpp"

#include <fmt/format.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>
#include <unistd.h>
#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstddef>
#include <exception>
#include <future>
#include <mutex>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <thread>
#include <vector>

#include "nysalt/detail/rounding.hpp"
#include "with_threads.hpp"

namespace nysalt::detail {

namespace {

/// Threads that wait until all of them are started, and end with the object.
class waiting_threads {
 public:
  /// Throws std::system_error if the system does not start them all.
  explicit waiting_threads(std::size_t count) : numbers_(count) {
    const std::shared_future<void> end = end_.get_future().share();
    threads_.reserve(count);
    try {
      for (pid_t& number : numbers_) {
        threads_.emplace_back([&number, end] {
          number = gettid();
          end.wait();
        });
      }
    } catch (...) {
      finish();
      throw;
    }
  }
  ~waiting_threads() { finish(); }
  waiting_threads(const waiting_threads&) = delete;
  waiting_threads& operator=(const waiting_threads&) = delete;

 private:
  /// A thread that was joined counts for the system until it has no number there, some microseconds later.
  void finish() {
    end_.set_value();
    for (auto& thread : threads_) thread.join();
    const auto is_there = [](pid_t number) { return number != 0 && tgkill(getpid(), number, 0) == 0; };
    constexpr int most_tries = 1000;  // a tenth of a second
    for (int tries = 0; tries < most_tries && std::ranges::any_of(numbers_, is_there); ++tries) {
      std::this_thread::sleep_for(std::chrono::microseconds(100));
    }
  }

  std::promise<void> end_;
  std::vector<pid_t> numbers_;
  std::vector<std::thread> threads_;
};

}  // namespace

void require_threads(int threads) {
  static std::atomic<int> known = 1;
  if (threads <= known) return;
  try {
    const waiting_threads others(static_cast<std::size_t>(threads) - 1);
  } catch (const std::system_error& problem) {
    refuse_threads(threads, problem.what());
  }
  known = threads;
}

void refuse_threads(int threads, std::string_view reason) {
  throw std::runtime_error(
      fmt::format("threads must be as many as the system starts, got {} ({}); take fewer", threads, reason));
}

}  // namespace nysalt::detail

namespace nysalt {

void for_each_block(std::int64_t count, int width, int threads,
                    const std::function<void(std::int64_t, int)>& body,
                    const std::function<void(std::int64_t)>& progress) {
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

void for_each_trajectory(std::int64_t count, int threads, const std::function<void(std::int64_t)>& body,
                         const std::function<void(std::int64_t)>& progress) {
  for_each_block(
      count, 1, threads, [&](std::int64_t m, int) { body(m); }, progress);
}

}  // namespace nysalt
