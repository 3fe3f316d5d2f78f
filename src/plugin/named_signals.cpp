// SPDX-License-Identifier: BSL-1.0
#include "named_signals.hpp"

#include <unistd.h>

#include <array>
#include <csignal>
#include <cstring>
#include <string_view>
#include <utility>

namespace nysalt::program {

namespace {

constexpr std::array<std::pair<int, std::string_view>, 5> fatal{
    {{SIGSEGV, "SIGSEGV"}, {SIGBUS, "SIGBUS"}, {SIGFPE, "SIGFPE"}, {SIGILL, "SIGILL"}, {SIGABRT, "SIGABRT"}}};

std::array<char, 512> end_of_line{};  // a handler may not allocate
volatile std::size_t length = 0;
bool is_allowed = false;

void put(std::string_view text) {
  [[maybe_unused]] const auto written = ::write(STDERR_FILENO, text.data(), text.size());
}

extern "C" void name_signal(int number) {
  put("nysalt: ");
  for (const auto& [known, name] : fatal) {
    if (known == number) put(name);
  }
  put({end_of_line.data(), length});
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
  for (const auto& [number, name] : fatal) std::signal(number, &name_signal);
}

}  // namespace nysalt::program
