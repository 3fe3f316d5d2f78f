// SPDX-License-Identifier: BSL-1.0
// What we use of TBB, on the standard's threads: ThreadSanitizer knows them. It does not see into the library
// TBB, takes what that orders for unordered, and would report races that are none. `./dev check threads`
// finds this in TBB's place.
#pragma once

#include <atomic>
#include <cstddef>
#include <thread>
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
    const int outside = threads_here;
    threads_here = threads_;
    f();
    threads_here = outside;
  }

  inline static thread_local int threads_here = 1;

 private:
  int threads_;
};

/// The body throws nothing: ours catch for themselves.
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
  for (int k = 1; k < task_arena::threads_here; ++k) others.emplace_back(work);
  work();
  for (auto& worker : others) worker.join();
}

}  // namespace oneapi::tbb
