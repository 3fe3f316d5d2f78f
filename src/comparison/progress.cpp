// SPDX-License-Identifier: BSL-1.0
#include "progress.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <system_error>
#include <utility>

#include "all_ranks.hpp"
#include "nysalt/atomic_file.hpp"
#include "standard_error.hpp"

namespace nysalt::program {

namespace {

thread_local quiet_caller* caller_here = nullptr;

std::string in_words(double seconds) {
  if (seconds < 60.0) return fmt::format("{:.0f} s", seconds);
  if (seconds < 7200.0) return fmt::format("{:.0f} min", seconds / 60.0);
  return fmt::format("{:.1f} h", seconds / 3600.0);
}

constexpr double too_early = 2.0;  // seconds, to say how many

}  // namespace

work_for::work_for(quiet_caller& caller) : before_(std::exchange(caller_here, &caller)) {}
work_for::~work_for() { caller_here = before_; }

progress::progress(std::chrono::milliseconds between_lines)
    : caller_(caller_here),
      speech_(caller_ != nullptr || !speaks_for_all() ? speech::none
              : has_terminal()                        ? speech::line
                                                      : speech::log),
      between_lines_(between_lines) {}

progress::~progress() {
  {
    const std::lock_guard lock(saying_);
    ends_ = true;
  }
  end_.notify_all();
  if (beats_.joinable()) beats_.join();
  take_away();
}

void progress::expect(double work) {
  const std::lock_guard lock(saying_);
  expected_ = work;
  done_ = part_ = 0.0;
  began_ = clock::now();
}

void progress::count(std::size_t total, std::string things) {
  const std::lock_guard lock(saying_);
  total_ = total;
  present_ = 0;
  things_ = std::move(things);
  count_began_ = clock::now();
}

void progress::next() {
  const std::lock_guard lock(saying_);
  if (present_ < total_) ++present_;
}

void progress::part(std::string what, double work) {
  const std::lock_guard lock(saying_);
  what_ = std::move(what);
  share_ = -1.0;
  part_began_ = clock::now();
  done_ += part_;
  part_ = work;
  if (caller_ != nullptr && caller_->hears) caller_->hears(what_, 0.0);
  if (speech_ == speech::none) return;
  say();
  if (beats_.joinable()) return;
  try {
    const nysalt::detail::held_signals held;  // for good on the new thread: handlers run on this one
    beats_ = std::thread([this] { beat(); });
  } catch (const std::system_error&) {  // for want of threads: counters speak
  }
}

std::function<void(std::int64_t)> progress::counter(std::int64_t total) {
  if (caller_ == nullptr && (speech_ == speech::none || total < 1)) return {};
  auto last = std::make_shared<std::atomic<std::int64_t>>(0);
  return [this, last, total](std::int64_t done) {
    if (caller_ != nullptr && caller_->wants_an_end) throw ended_early();
    if ((caller_ != nullptr && !caller_->hears) || total < 1) return;
    const std::int64_t percent = 100 * done / total;
    if (last->exchange(percent) >= percent) return;
    const std::lock_guard lock(saying_);
    share_ = std::max(share_, static_cast<double>(percent) / 100.0);
    if (caller_ != nullptr) return caller_->hears(what_, share_);
    say();
  };
}

double progress::seconds_since(clock::time_point t) {
  return std::chrono::duration<double>(clock::now() - t).count();
}

std::string progress::text() const {
  const std::string left = time_left();
  if (present_ > 0) {
    return fmt::format("{} of {} {}{}: {}", present_, total_, things_, left.empty() ? "" : ", " + left,
                       what_);
  }
  const std::string in_brackets = left.empty() ? "" : " (" + left + ")";
  if (share_ >= 0.0) return fmt::format("{}: {:.0f} %{}", what_, 100.0 * share_, in_brackets);
  const double seconds = seconds_since(part_began_);
  if (!left.empty() || seconds < too_early) return fmt::format("{} ...{}", what_, in_brackets);
  return fmt::format("{} ... ({} so far)", what_, in_words(seconds));
}

std::string progress::time_left() const {
  // Of the whole work where it is known, else of the things that are counted, else of the part.
  const bool is_known = expected_ > 0.0;
  const bool is_counted = !is_known && present_ > 0;
  const double share = std::max(share_, 0.0);
  const double done = is_known     ? (done_ + share * part_) / expected_
                      : is_counted ? static_cast<double>(present_ - 1) / static_cast<double>(total_)
                                   : share;
  const double seconds = seconds_since(is_known ? began_ : is_counted ? count_began_ : part_began_);
  if (!(done > 0.0) || !(done < 1.0) || seconds < too_early) return {};
  return fmt::format("{} left", in_words(seconds * (1.0 / done - 1.0)));
}

void progress::step_aside() {
  const std::lock_guard lock(saying_);
  take_away();
}

void progress::clear() {
  const std::lock_guard lock(saying_);
  total_ = present_ = 0;
  what_.clear();
  take_away();
}

void progress::take_away() {
  if (shown_) to_standard_error("\r\033[K");
  shown_ = false;
}

void progress::say() {
  if (what_.empty()) return;
  if (speech_ == speech::line) {
    shown_ = true;
    to_standard_error(fmt::format("\r\033[K{}", text()));
  } else if (clock::now() - last_line_ >= between_lines_) {
    last_line_ = clock::now();
    to_standard_error(fmt::format("nysalt: {}\n", text()));
  }
}

void progress::beat() {
  std::unique_lock lock(saying_);
  const auto often = std::min<clock::duration>(std::chrono::seconds(1), between_lines_);
  while (!end_.wait_for(lock, often, [this] { return ends_; })) say();
}

}  // namespace nysalt::program
