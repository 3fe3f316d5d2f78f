// SPDX-License-Identifier: BSL-1.0
// A black box whose force and potential have memory: two threads in one object are an error of the caller.
#pragma once

#include <atomic>
#include <thread>

#include "nysalt/system.hpp"

namespace nysalt::test {

/// An oscillator that counts how often two threads met in one object. A copy begins anew; each Test has a
/// count of its own.
template <class Test>
struct with_memory {
  static constexpr int dimension = 1;
  static inline std::atomic<int> meetings = 0;
  mutable std::atomic<int> inside = 0;

  with_memory() = default;
  with_memory(const with_memory&) {}
  with_memory& operator=(const with_memory&) { return *this; }
  ~with_memory() = default;

  void force(const vector<double, 1>& q, vector<double, 1>& f) const {
    visit();
    f[0] = -q[0];
  }
  double potential(const vector<double, 1>& q) const {
    visit();
    return 0.5 * q[0] * q[0];
  }

 private:
  void visit() const {
    if (++inside != 1) ++meetings;
    std::this_thread::yield();
    --inside;
  }
};

}  // namespace nysalt::test
