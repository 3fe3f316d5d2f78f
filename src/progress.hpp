// SPDX-License-Identifier: BSL-1.0
// How far a long computation is: a line on a terminal, nothing in a pipe.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>

namespace nysalt::program {

/// A line on standard error that is overwritten as work is done, and gone at the end.
class progress {
 public:
  progress();
  ~progress();
  progress(const progress&) = delete;
  progress& operator=(const progress&) = delete;

  /// The work of all parts to come, in any unit: with it the line tells how much time is left.
  void expect(double work);
  /// Begins a part of the work; what was begun before is done.
  void part(std::string what, double work = 0.0);
  /// Work that was expected and need not be done.
  void skip(double work) { expected_ -= work; }
  /// To be called with the number of units of the part that are done, out of `total`; from any thread.
  std::function<void(std::int64_t)> counter(std::int64_t total);
  /// Takes the line away.
  void clear();

 private:
  using clock = std::chrono::steady_clock;

  /// " (3 min left)", when enough is done to tell.
  std::string time_left(double share_of_part) const;
  void show(const std::string& text);

  std::mutex showing_;
  bool visible_;
  bool shown_ = false;
  std::string what_;
  double expected_ = 0.0;
  double done_ = 0.0;  // before the part at hand
  double part_ = 0.0;
  clock::time_point began_ = clock::now();
};

}  // namespace nysalt::program
