// SPDX-License-Identifier: BSL-1.0
#include "progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <cstdio>
#include <memory>
#include <utility>

namespace nysalt::program {

progress::progress() : visible_(isatty(STDERR_FILENO) != 0) {}
progress::~progress() { clear(); }

void progress::part(std::string what) {
  what_ = std::move(what);
  show(what_ + " ...");
}

std::function<void(std::int64_t)> progress::counter(std::int64_t total) {
  if (!visible_ || total < 1) return {};
  auto last = std::make_shared<std::atomic<std::int64_t>>(0);
  return [this, last, total](std::int64_t done) {
    const std::int64_t percent = 100 * done / total;
    if (last->exchange(percent) < percent) show(fmt::format("{}: {} %", what_, percent));
  };
}

void progress::clear() {
  if (shown_) fmt::print(stderr, "\r\033[K");
  shown_ = false;
}

void progress::show(const std::string& text) {
  if (!visible_) return;
  const std::lock_guard lock(showing_);
  shown_ = true;
  fmt::print(stderr, "\r\033[K{}", text);
  std::fflush(stderr);
}

}  // namespace nysalt::program
