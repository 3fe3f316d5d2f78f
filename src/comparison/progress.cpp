// SPDX-License-Identifier: BSL-1.0
#include "progress.hpp"

#include <fmt/format.h>

#include <atomic>
#include <memory>
#include <utility>

#include "all_ranks.hpp"
#include "standard_error.hpp"

namespace nysalt::program {

namespace {
thread_local quiet_caller* caller_here = nullptr;
}  // namespace

work_for::work_for(quiet_caller& caller) : before_(std::exchange(caller_here, &caller)) {}
work_for::~work_for() { caller_here = before_; }

progress::progress()
    : caller_(caller_here), visible_(caller_ == nullptr && speaks_for_all() && has_terminal()) {}
progress::~progress() { clear(); }

void progress::expect(double work) {
  expected_ = work;
  done_ = part_ = 0.0;
  began_ = clock::now();
}

void progress::part(std::string what, double work) {
  what_ = std::move(what);
  done_ += part_;
  part_ = work;
  show(fmt::format("{} ...{}", what_, time_left(0.0)));
}

std::function<void(std::int64_t)> progress::counter(std::int64_t total) {
  if (caller_ != nullptr) {
    return [caller = caller_](std::int64_t) {
      if (caller->wants_an_end) throw ended_early();
    };
  }
  if (!visible_ || total < 1) return {};
  auto last = std::make_shared<std::atomic<std::int64_t>>(0);
  return [this, last, total](std::int64_t done) {
    const std::int64_t percent = 100 * done / total;
    if (last->exchange(percent) >= percent) return;
    show(fmt::format("{}: {} %{}", what_, percent, time_left(0.01 * static_cast<double>(percent))));
  };
}

std::string progress::time_left(double share_of_part) const {
  const double done = done_ + share_of_part * part_;
  const double seconds = std::chrono::duration<double>(clock::now() - began_).count();
  constexpr double too_early = 2.0;
  if (!(done > 0.0) || !(expected_ > done) || seconds < too_early) return {};
  const double left = seconds * (expected_ / done - 1.0);
  if (left < 60.0) return fmt::format(" ({:.0f} s left)", left);
  if (left < 7200.0) return fmt::format(" ({:.0f} min left)", left / 60.0);
  return fmt::format(" ({:.1f} h left)", left / 3600.0);
}

void progress::clear() {
  if (shown_) to_standard_error("\r\033[K");
  shown_ = false;
}

void progress::show(const std::string& text) {
  if (!visible_) return;
  const std::lock_guard lock(showing_);
  shown_ = true;
  to_standard_error(fmt::format("\r\033[K{}", text));
}

}  // namespace nysalt::program
