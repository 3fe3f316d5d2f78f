// SPDX-License-Identifier: BSL-1.0
// While a file is made and its name noted no handler runs, on no thread.
#include "nysalt/detail/held_signals.hpp"

#include <boost/test/unit_test.hpp>

#include <atomic>
#include <chrono>
#include <csignal>
#include <future>
#include <thread>

using nysalt::detail::held_signals;
using nysalt::detail::wait_for_held_signals;

namespace {

volatile std::sig_atomic_t handled = 0;
extern "C" void note(int) { handled = handled + 1; }

}  // namespace

BOOST_AUTO_TEST_CASE(a_handler_runs_behind_the_scope) {
  const auto before = std::signal(SIGUSR1, &note);
  std::raise(SIGUSR1);
  BOOST_TEST(handled == 1);  // not held
  {
    const held_signals held;
    std::raise(SIGUSR1);
    BOOST_TEST(handled == 1);
  }
  BOOST_TEST(handled == 2);
  std::signal(SIGUSR1, before);
}

BOOST_AUTO_TEST_CASE(a_handler_on_another_thread_waits) {
  wait_for_held_signals();  // returns at once, as no thread holds signals back
  std::promise<void> holds;
  std::atomic<bool> is_done = false;
  std::thread other([&] {
    const held_signals held;
    holds.set_value();
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    is_done = true;
  });
  holds.get_future().wait();
  wait_for_held_signals();
  BOOST_TEST(is_done);
  other.join();
}
