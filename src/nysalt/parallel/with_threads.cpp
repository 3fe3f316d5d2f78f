// SPDX-License-Identifier: BSL-1.0

#include "with_threads.hpp"

#include <unistd.h>
#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstddef>
#include <future>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <thread>
#include <vector>

#include "nysalt/core/sentence.hpp"

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
      sentence("threads must be as many as the system starts, got {} ({}); take fewer", threads, reason));
}

}  // namespace nysalt::detail
