// SPDX-License-Identifier: BSL-1.0
#include "interruption.hpp"

#include <unistd.h>

#include <array>
#include <atomic>
#include <csignal>
#include <initializer_list>
#include <string_view>
#include <utility>

#include "all_ranks.hpp"
#include "child_process.hpp"
#include "nysalt/atomic_file.hpp"

namespace nysalt::program {

namespace {

std::atomic<int> noted = 0;
std::string words;  // changed while signals are held back
std::atomic<bool> is_noting = false;

/// Async-signal-safe.
void say_last_words(int number) {
  if (words.empty()) return;
  constexpr std::string_view before = "nysalt: signal ";
  constexpr std::string_view after = " ended the search; ";
  const std::array<char, 2> digits{static_cast<char>('0' + number / 10 % 10),
                                   static_cast<char>('0' + number % 10)};
  const std::string_view of_number(digits.data() + (number < 10 ? 1 : 0), number < 10 ? 1 : 2);
  for (const std::string_view part : {before, of_number, after, std::string_view(words)}) {
    if (::write(STDERR_FILENO, part.data(), part.size()) < 0) return;
  }
}

extern "C" void end_by_signal(int number) {
  int none = 0;
  if (is_noting && noted.compare_exchange_strong(none, number)) return;
  nysalt::detail::wait_for_held_signals();
  end_child();
  nysalt::detail::remove_unfinished_files();
  say_last_words(number);
  ::_exit(128 + number);
}

enum class handlers_of_others { replaced, kept };

void handle(int number, handlers_of_others others) {
  struct sigaction before {};
  if (sigaction(number, nullptr, &before) != 0 || before.sa_handler == SIG_IGN) return;  // nohup
  if (others == handlers_of_others::kept && before.sa_handler != SIG_DFL) return;
  struct sigaction handled {};
  handled.sa_handler = &end_by_signal;
  handled.sa_flags = SA_RESTART;
  sigaction(number, &handled, nullptr);
}

}  // namespace

void handle_signals() {
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGUSR1, SIGUSR2, SIGXCPU})
    handle(number, handlers_of_others::replaced);
  // Other signals whose default action ends the process, except those of faults; the handler of a profiler
  // stays.
  for (const int number : {SIGQUIT, SIGALRM, SIGVTALRM, SIGPROF, SIGIO, SIGPWR, SIGSTKFLT})
    handle(number, handlers_of_others::kept);
  for (int number = SIGRTMIN; number <= SIGRTMAX; ++number) handle(number, handlers_of_others::kept);
}

signals_are_noted::signals_are_noted() noexcept { is_noting = true; }
signals_are_noted::~signals_are_noted() { is_noting = false; }

last_words::last_words(std::string text) { set(std::move(text)); }
last_words::~last_words() { set({}); }

void last_words::set(std::string text, const std::function<void()>& done) {
  if (!text.empty()) text += '\n';
  if (!speaks_for_all()) text.clear();
  const nysalt::detail::held_signals held;
  if (done) done();
  words = std::move(text);
}

int noted_signal() noexcept { return noted; }

}  // namespace nysalt::program
