// SPDX-License-Identifier: BSL-1.0
// Progress of a long computation: a line on a terminal; elsewhere a line a minute.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

namespace nysalt::program {

/// A caller that uses the program as a library: no line is printed, and the caller may end the work early.
struct quiet_caller {
  std::atomic<bool> wants_an_end = false;
  /// Callback with the name of the current part and its completed share, one call at a time; an exception
  /// that it throws cancels the work. Empty: no callback.
  std::function<void(const std::string&, double)> hears = {};
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

/// A line on standard error that is overwritten as work is done, and gone at the end. Where that is no
/// terminal, a line of its own a minute: nothing of work that takes less. None for a caller.
class progress {
 public:
  explicit progress(std::chrono::milliseconds between_lines = std::chrono::minutes(1));
  ~progress();
  progress(const progress&) = delete;
  progress& operator=(const progress&) = delete;

  /// The work of all parts to come, in any unit: with it the line has the remaining time.
  void expect(double work);
  /// Sets the number of items that the following parts work on, shown as in "9 of 21 families, 40 s left".
  /// Zero ends the count.
  void count(std::size_t total, std::string things);
  /// Begins the next item.
  void next();
  /// Begins a part of the work; what was begun before is done.
  void part(std::string what, double work = 0.0);
  /// Work that was expected and need not be done.
  void skip(double work) { expected_ -= work; }
  /// To be called with the number of units of the part that are done, out of `total`; from any thread. Throws
  /// ended_early where a caller wants an end.
  std::function<void(std::int64_t)> counter(std::int64_t total);
  /// Takes the line away, as something else is printed; the part goes on.
  void step_aside();
  /// Takes the line away, until another part begins.
  void clear();

 private:
  using clock = std::chrono::steady_clock;
  enum class speech { none, line, log };

  static double seconds_since(clock::time_point t);
  /// "judging the step ... (12 s so far)", "running: 34 % (3 min left)"
  std::string text() const;
  /// "3 min left", when enough is done to estimate it; else empty.
  std::string time_left() const;
  // With the lock:
  void say();
  void take_away();
  /// Says from time to time what is done, where nothing counts.
  void beat();

  std::mutex saying_;
  quiet_caller* caller_;  // null in the program
  speech speech_;
  clock::duration between_lines_;
  bool shown_ = false;
  std::string what_;     // empty: no part is under way
  double share_ = -1.0;  // of the part; negative: nothing counts
  double expected_ = 0.0;
  double done_ = 0.0;  // before the present part
  double part_ = 0.0;
  std::size_t total_ = 0;    // things; 0: nothing is counted
  std::size_t present_ = 0;  // the one under way, from 1 on
  std::string things_;
  clock::time_point began_ = clock::now();
  clock::time_point count_began_ = began_;
  clock::time_point part_began_ = began_;
  clock::time_point last_line_ = began_;
  bool ends_ = false;
  std::condition_variable end_;
  std::thread beats_;
};

}  // namespace nysalt::program
