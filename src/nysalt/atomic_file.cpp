// SPDX-License-Identifier: BSL-1.0

#include "nysalt/atomic_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <ctime>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

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

namespace {

constexpr std::size_t longest = 4096;  // PATH_MAX of Linux

struct slot {
  std::atomic<bool> is_taken = false;
  std::atomic<bool> is_set = false;
  std::array<char, longest> name{};
};
std::array<slot, 32> slots;

}  // namespace

unfinished_name::unfinished_name(const std::filesystem::path& file) : place_(slots.size()) {
  std::error_code ignored;
  const std::string name = std::filesystem::absolute(file, ignored).string();
  if (name.size() >= longest) return;
  for (std::size_t i = 0; i < slots.size(); ++i) {
    if (slots[i].is_taken.exchange(true)) continue;
    std::copy(name.begin(), name.end(), slots[i].name.begin());
    slots[i].name[name.size()] = '\0';
    slots[i].is_set = true;
    place_ = i;
    return;
  }
}

unfinished_name::~unfinished_name() {
  if (place_ >= slots.size()) return;
  slots[place_].is_set = false;
  slots[place_].is_taken = false;
}

void remove_unfinished_files() noexcept {
  for (slot& one : slots) {
    if (one.is_set) ::unlink(one.name.data());
  }
}

}  // namespace nysalt::detail

namespace nysalt {

void detail::put_folder_on_disk(const std::filesystem::path& file) {
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
  const int descriptor = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  fsync(descriptor);
  close(descriptor);
}

namespace detail {

bool has_name(int file, const std::filesystem::path& name) {
  struct stat opened {};
  struct stat named {};
  return fstat(file, &opened) == 0 && lstat(name.c_str(), &named) == 0 && opened.st_ino == named.st_ino &&
         opened.st_dev == named.st_dev;
}

namespace {

[[noreturn]] void cannot_write(const std::filesystem::path& file, std::string_view why) {
  throw std::runtime_error(fmt::format("cannot write {}: {}", file.string(), why));
}

[[noreturn]] void another_writes(const std::filesystem::path& file) {
  throw file_in_use(fmt::format(
      "cannot write {}: another process writes it; wait for that, or name another file", file.string()));
}

[[noreturn]] void failed_to_write(const std::filesystem::path& file) {
  throw write_failure(
      fmt::format("cannot write {}: the folder is not there, not writable, or full", file.string()));
}

/// Whether nothing was written for so long that no process is at it. For file systems without locks alone.
bool is_old(const struct stat& file) {
  constexpr std::time_t seconds = 10;  // far longer than from one piece of a table to the next
  return std::time(nullptr) - file.st_mtim.tv_sec > seconds;
}

/// Removes what a process that was stopped left at the name; that of a living one is locked.
void remove_left(const std::filesystem::path& part, const std::filesystem::path& target) {
  const int left = open(part.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (left < 0 && errno == ENOENT) return;  // gone meanwhile
  struct stat found {};
  const bool is_file = left >= 0 && fstat(left, &found) == 0 && S_ISREG(found.st_mode);
  const lock_outcome lock = is_file ? ask_for_lock(left) : lock_outcome::held_by_another;
  const bool is_free = lock == lock_outcome::taken || (lock == lock_outcome::unavailable && is_old(found));
  if (is_free && has_name(left, part)) unlink(part.c_str());
  if (left >= 0) close(left);
  if (!is_file)
    cannot_write(target, fmt::format("{} exists and is not a regular file; remove it", part.string()));
  if (!is_free) another_writes(target);
}

/// What a symbolic link leads to, in one step; nothing if the path is no link, or cannot be read.
std::optional<std::filesystem::path> behind_link(const std::filesystem::path& path) {
  std::error_code failure;
  if (!std::filesystem::is_symlink(path, failure)) return {};
  const auto next = std::filesystem::read_symlink(path, failure);
  if (failure) return {};
  return path.parent_path() / next;  // an absolute one replaces all before it
}

/// Whether the kernel makes what is in a folder: devices, or names of what processes have open. A file system
/// that is mounted below /dev, as /dev/shm, is for files.
bool is_of_kernel(const std::filesystem::path& folder) {
  std::error_code failure;
  const auto whole = std::filesystem::canonical(folder, failure).string() + '/';
  if (failure) return false;
  for (const std::string root : {"/dev", "/proc"}) {
    struct stat here {};
    struct stat there {};
    if (whole.starts_with(root + '/') && stat(folder.c_str(), &here) == 0 && stat(root.c_str(), &there) == 0)
      return here.st_dev == there.st_dev;
  }
  return false;
}

constexpr int longest_chain = 40;  // of links, as many as Linux follows

}  // namespace

std::string objection_to_replacing(const std::filesystem::path& file) {
  std::optional<std::filesystem::path> name = file;
  for (int i = 0; i < longest_chain && name; ++i, name = behind_link(*name)) {
    if (is_of_kernel(name->has_parent_path() ? name->parent_path() : "."))
      return "it is not a regular file; name another";
  }
  struct stat found {};
  if (lstat(behind_links(file).c_str(), &found) != 0 || S_ISREG(found.st_mode)) return {};
  if (S_ISDIR(found.st_mode)) return "it is a folder; name another file";
  if (S_ISLNK(found.st_mode)) return "it is a link that leads back to itself; remove it";
  return "it is not a regular file; name another";
}

lock_outcome ask_for_lock(int file) {
  while (flock(file, LOCK_EX | LOCK_NB) != 0) {
    if (errno == EWOULDBLOCK) return lock_outcome::held_by_another;
    if (errno != EINTR) return lock_outcome::unavailable;
  }
  return lock_outcome::taken;
}

descriptor::~descriptor() {
  if (number_ >= 0) close(number_);
}

descriptor held(const std::filesystem::path& file) {
  descriptor found(open(file.c_str(), O_RDWR | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
  if (found.number() < 0 && errno == ENOENT) return found;
  if (const auto why = objection_to_replacing(file); !why.empty()) cannot_write(file, why);
  if (found.number() < 0) failed_to_write(file);
  // Who held the lock before may have given the name to another file meanwhile.
  if (ask_for_lock(found.number()) == lock_outcome::held_by_another || !has_name(found.number(), file))
    another_writes(file);
  return found;
}

bool is_locked(const std::filesystem::path& file) {
  const int opened = open(file.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (opened < 0) return false;
  const bool is_held = flock(opened, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  close(opened);
  return is_held;
}

int make_part(const std::filesystem::path& part, const std::filesystem::path& target,
              std::optional<unfinished_name>& name) {
  if (target.native().find('\0') != std::string::npos) {
    cannot_write(std::string(target.c_str()) + "...",
                 "the name must hold no zero byte, got one; name another file");
  }
  if (const auto why = objection_to_replacing(target); !why.empty()) cannot_write(target, why);
  constexpr int attempts = 8;  // others may make and remove theirs meanwhile
  for (int i = 0; i < attempts; ++i) {
    const held_signals held;
    const int file = open(part.c_str(), O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
    if (file >= 0) {
      if (ask_for_lock(file) != lock_outcome::held_by_another && has_name(file, part)) {
        name.emplace(part);
        return file;
      }
      close(file);
      continue;
    }
    if (errno != EEXIST) failed_to_write(target);
    remove_left(part, target);
  }
  another_writes(target);
}

std::filesystem::path behind_links(const std::filesystem::path& file) {
  std::filesystem::path found = file;
  for (int i = 0; i < longest_chain; ++i) {
    const auto next = behind_link(found);
    if (!next) break;
    found = *next;
  }
  return found;
}

}  // namespace detail

atomic_file::atomic_file(std::filesystem::path path) : atomic_file(std::move(path), "new") {}

atomic_file::atomic_file(std::filesystem::path path, const std::string& writer)
    : path_(detail::behind_links(path)),
      part_(path_.string() + fmt::format(".{}.part", writer)),
      file_(detail::make_part(part_, path_, name_)) {}

atomic_file::~atomic_file() {
  std::error_code ignored;
  if (!committed_ && detail::has_name(file_, part_)) std::filesystem::remove(part_, ignored);
  if (file_ >= 0) close(file_);
}

void atomic_file::write(std::string_view text) {
  constexpr std::size_t enough = std::size_t{1} << 16U;
  gathered_ += text;
  if (gathered_.size() > enough) write_gathered();
}

void atomic_file::write_gathered() {
  std::string_view left = gathered_;
  while (!left.empty()) {
    const ssize_t done = ::write(file_, left.data(), left.size());
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) fail();
    left.remove_prefix(static_cast<std::size_t>(done));
  }
  gathered_.clear();
}

void atomic_file::commit(bool durable) {
  write_gathered();
  if (durable && fsync(file_) != 0) fail();
  if (const auto why = detail::objection_to_replacing(path_); !why.empty())
    throw detail::write_failure(fmt::format("cannot write {}: {}", path_.string(), why));
  if (!detail::has_name(file_, part_)) {
    throw detail::write_failure(
        fmt::format("cannot write {}: another process removed or replaced {}; write it again", path_.string(),
                    part_.string()));
  }
  std::error_code failure;
  std::filesystem::rename(part_, path_, failure);
  if (failure) fail();
  committed_ = true;
  name_.reset();
  if (durable) detail::put_folder_on_disk(path_);
}

void atomic_file::fail() const { detail::failed_to_write(path_); }

}  // namespace nysalt
