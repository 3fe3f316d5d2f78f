// SPDX-License-Identifier: BSL-1.0
// Progress of a long computation: a line on a terminal, nothing in a pipe.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>
#include <string>

namespace nysalt::program {

/// A caller that uses the program as a library: no line is printed, and the caller may end the work early.
struct quiet_caller {
  std::atomic<bool> wants_an_end = false;
};
/// The exception that a counter throws then.
class ended_early : public std::exception {
 public:
  const char* what() const noexcept override { return "the work was ended before it was done"; }
};
/// While this lives, work on this thread is done for a caller.
class work_for {
 public:
  explicit work_for(quiet_caller& caller);
  ~work_for();
  work_for(const work_for&) = delete;
  work_for& operator=(const work_for&) = delete;

 private:
  quiet_caller* before_;
};

/// A line on standard error that is overwritten as work is done, and gone at the end; or none, for a caller.
class progress {
 public:
  progress();
  ~progress();
  progress(const progress&) = delete;
  progress& operator=(const progress&) = delete;

  /// The work of all parts to come, in any unit: with it the line has the remaining time.
  void expect(double work);
  /// Begins a part of the work; what was begun before is done.
  void part(std::string what, double work = 0.0);
  /// Work that was expected and need not be done.
  void skip(double work) { expected_ -= work; }
  /// To be called with the number of units of the part that are done, out of `total`; from any thread. Throws
  /// ended_early where a caller wants an end.
  std::function<void(std::int64_t)> counter(std::int64_t total);
  /// Takes the line away.
  void clear();

 private:
  using clock = std::chrono::steady_clock;

  /// " (3 min left)", when enough is done to estimate it.
  std::string time_left(double share_of_part) const;
  void show(const std::string& text);

  std::mutex showing_;
  quiet_caller* caller_;  // null in the program
  bool visible_;
  bool shown_ = false;
  std::string what_;
  double expected_ = 0.0;
  double done_ = 0.0;  // before the present part
  double part_ = 0.0;
  clock::time_point began_ = clock::now();
};

}  // namespace nysalt::program
