// SPDX-License-Identifier: BSL-1.0
// Steps between which no signal handler runs.
#pragma once

#include <csignal>

namespace nysalt::detail {

/// Holds signals back from this thread; a handler on another thread waits by wait_for_held_signals(). For
/// what a handler must find whole, such as a new file and the note of the name.
class held_signals {
 public:
  held_signals() noexcept;
  ~held_signals();
  held_signals(const held_signals&) = delete;
  held_signals& operator=(const held_signals&) = delete;

  const sigset_t& before() const { return before_; }  ///< signals that were held back before

 private:
  sigset_t before_{};
};

/// In a handler: waits while another thread holds signals back, a second at most. Async-signal-safe.
void wait_for_held_signals() noexcept;

}  // namespace nysalt::detail
