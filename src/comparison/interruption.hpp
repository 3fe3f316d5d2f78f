// SPDX-License-Identifier: BSL-1.0
// Signals that end the program: SIGINT, SIGTERM, SIGHUP, and those by which batch systems warn, SIGUSR1,
// SIGUSR2 and SIGXCPU.
#pragma once

#include <exception>
#include <functional>
#include <string>

namespace nysalt::program {

/// Thrown where work ends because of a signal that was noted, here or at another rank.
class interrupted : public std::exception {
 public:
  explicit interrupted(int signal) : signal_(signal) {}
  int signal() const noexcept { return signal_; }
  const char* what() const noexcept override { return "ended by a signal"; }

 private:
  int signal_;
};

/// Has the signals handled: of a process that is ended by one, files that are not finished go, and the exit
/// code is 128 and the signal's number. For a program, once.
void handle_signals();

/// While one lives, the first signal is noted and the work goes on, to where it can be gone on with later;
/// the second ends the process.
class signals_are_noted {
 public:
  signals_are_noted() noexcept;
  ~signals_are_noted();
  signals_are_noted(const signals_are_noted&) = delete;
  signals_are_noted& operator=(const signals_are_noted&) = delete;
};

/// While one lives, a process that a signal ends says a sentence of it on standard error: "signal 15 ended
/// the search; ..." with the text. One at a time; rank 0 speaks.
class last_words {
 public:
  explicit last_words(std::string text);
  ~last_words();
  last_words(const last_words&) = delete;
  last_words& operator=(const last_words&) = delete;
  /// Other words, once `done` has been done: no signal comes between the two.
  void set(std::string text, const std::function<void()>& done = {});
};

/// The number of the signal that was noted; 0 if there was none.
int noted_signal() noexcept;

}  // namespace nysalt::program
