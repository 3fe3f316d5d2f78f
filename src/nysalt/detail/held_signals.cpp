// SPDX-License-Identifier: BSL-1.0
#include "nysalt/detail/held_signals.hpp"

#include <poll.h>

#include <atomic>

namespace nysalt::detail {

namespace {

std::atomic<int> holders = 0;

}  // namespace

held_signals::held_signals() noexcept {
  sigset_t all;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before_);
  ++holders;
}

held_signals::~held_signals() {
  --holders;
  pthread_sigmask(SIG_SETMASK, &before_, nullptr);
}

void wait_for_held_signals() noexcept {
  constexpr int most_milliseconds = 1000;
  for (int n = 0; holders > 0 && n < most_milliseconds; ++n) ::poll(nullptr, 0, 1);
}

}  // namespace nysalt::detail
