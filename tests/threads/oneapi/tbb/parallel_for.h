// SPDX-License-Identifier: BSL-1.0
// What we use of TBB, on the standard's threads: ThreadSanitizer knows them. It does not see into the library
// TBB, takes what that orders for unordered, and would report races that are none. `./dev check threads`
// finds this in TBB's place.
#pragma once

#include <atomic>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

namespace oneapi::tbb {

struct global_control {
  enum parameter { max_allowed_parallelism };
  global_control(parameter, std::size_t) {}
};

/// Its threads are those that a loop takes which runs in it.
class task_arena {
 public:
  explicit task_arena(int threads) : threads_(threads) {}

  template <class F>
  void execute(const F& f) const {
    const struct outside {
      int threads;
      int index;
      ~outside() {
        threads_here = threads;
        index_here = index;
      }
    } restored{std::exchange(threads_here, threads_), std::exchange(index_here, 0)};
    f();
  }

  inline static thread_local int threads_here = 1;
  inline static thread_local int index_here = 0;  // of the thread, among those of the loop

 private:
  int threads_;
};

namespace this_task_arena {
inline int current_thread_index() { return task_arena::index_here; }
}  // namespace this_task_arena

struct static_partitioner {};

/// The body throws nothing: ours catch for themselves. Throws std::runtime_error if a thread does not start,
/// with the first word of the message of TBB, when the threads that have started are done.
template <class Index, class Body>
void parallel_for(Index first, Index last, const Body& body) {
  // Relaxed, so that one call of the body is not ordered behind another by it.
  std::atomic<Index> next = first;
  const auto work = [&] {
    for (Index i = next.fetch_add(1, std::memory_order_relaxed); i < last;
         i = next.fetch_add(1, std::memory_order_relaxed)) {
      body(i);
    }
  };
  std::vector<std::thread> others;
  std::string problem;
  try {
    for (int k = 1; k < task_arena::threads_here; ++k) {
      others.emplace_back([&work, k] {
        task_arena::index_here = k;
        work();
      });
    }
  } catch (const std::system_error& failure) {
    problem = std::string("pthread_create: ") + failure.what();
  }
  work();
  for (auto& worker : others) worker.join();
  if (!problem.empty()) throw std::runtime_error(problem);
}

/// Who takes which calls is not what is looked for.
template <class Index, class Body>
void parallel_for(Index first, Index last, const Body& body, static_partitioner) {
  parallel_for(first, last, body);
}

}  // namespace oneapi::tbb
