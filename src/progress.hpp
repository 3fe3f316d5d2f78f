// SPDX-License-Identifier: BSL-1.0
// How far a long computation is: a line on a terminal, nothing in a pipe.
#pragma once

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

  /// Begins a part of the work.
  void part(std::string what);
  /// To be called with the number of units done, out of `total`; from any thread.
  std::function<void(std::int64_t)> counter(std::int64_t total);
  /// Takes the line away.
  void clear();

 private:
  void show(const std::string& text);

  std::mutex showing_;
  bool visible_;
  bool shown_ = false;
  std::string what_;
};

}  // namespace nysalt::program
