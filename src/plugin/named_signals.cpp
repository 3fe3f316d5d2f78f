// SPDX-License-Identifier: BSL-1.0
#include "named_signals.hpp"

#include <unistd.h>

#include <array>
#include <atomic>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <string_view>
#include <utility>

#include "nysalt/atomic_file.hpp"

namespace nysalt::program {

namespace {

constexpr std::array<std::pair<int, std::string_view>, 5> fatal{
    {{SIGSEGV, "SIGSEGV"}, {SIGBUS, "SIGBUS"}, {SIGFPE, "SIGFPE"}, {SIGILL, "SIGILL"}, {SIGABRT, "SIGABRT"}}};

std::array<char, 512> end_of_line{};  // a handler may not allocate
volatile std::size_t length = 0;
bool is_allowed = false;
std::atomic<bool> is_over = false;

void put(std::string_view text) {
  [[maybe_unused]] const auto written = ::write(STDERR_FILENO, text.data(), text.size());
}

/// A plug-in must not end the program: the exit code would say that all is done.
void name_exit() {
  if (is_over) return;
  put("nysalt: exit() was called");
  put({end_of_line.data(), length});
  nysalt::detail::remove_unfinished_files();
  ::_exit(2);
}

/// A stack that has overflowed has no room for a handler.
void handle_on_own_stack(int number, void (*handler)(int)) {
  static std::array<char, std::size_t{1} << 16U> room;
  stack_t stack{};
  stack.ss_sp = room.data();
  stack.ss_size = room.size();
  ::sigaltstack(&stack, nullptr);
  struct sigaction handled {};
  handled.sa_handler = handler;
  handled.sa_flags = SA_ONSTACK;
  ::sigaction(number, &handled, nullptr);
}

extern "C" void name_signal(int number) {
  put("nysalt: ");
  for (const auto& [known, name] : fatal) {
    if (known == number) put(name);
  }
  put({end_of_line.data(), length});
  nysalt::detail::remove_unfinished_files();
  std::signal(number, SIG_DFL);
  std::raise(number);
}

}  // namespace

void allow_named_signals() { is_allowed = true; }

void name_signals(const std::string& plugin) {
  if (!is_allowed) return;
  constexpr std::size_t most = end_of_line.size();
  std::string text = " while the plug-in " + plugin.substr(0, most / 2);
  text += " was in use: check the plug-in first\n";
  length = 0;
  std::memcpy(end_of_line.data(), text.data(), std::min(most, text.size()));
  length = std::min(most, text.size());
  for (const auto& [number, name] : fatal) handle_on_own_stack(number, &name_signal);
  static const bool is_registered = std::atexit(&name_exit) == 0;
  static_cast<void>(is_registered);
}

void allow_exit() { is_over = true; }

}  // namespace nysalt::program
