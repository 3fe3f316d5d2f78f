// SPDX-License-Identifier: BSL-1.0
// Files that are there whole or not at all, whatever fails and whatever signal comes.
#pragma once

#include <csignal>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

// Steps between which no signal handler runs.

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

// Files that must go if a signal ends the process.

/// The name of a file that is not finished, kept where a signal handler finds it. Of more than 32 at a time
/// the others are not kept.
class unfinished_name {
 public:
  explicit unfinished_name(const std::filesystem::path& file);
  ~unfinished_name();  ///< the file stays in any case
  unfinished_name(const unfinished_name&) = delete;
  unfinished_name& operator=(const unfinished_name&) = delete;

 private:
  std::size_t place_;
};

/// Removes all files whose names are kept. Async-signal-safe.
void remove_unfinished_files() noexcept;

/// A failure to write that is not due to bad input: the disk is full, or a device failed.
class write_failure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Another process writes the file.
class file_in_use : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Why a file that is written must not take the name, or the place of what a link of that name leads to: a
/// folder, a device, a FIFO or a socket is there, or a link that leads back to itself. Empty if a regular
/// file or nothing is there.
std::string objection_to_replacing(const std::filesystem::path& file);

}  // namespace nysalt::detail

namespace nysalt {

namespace detail {

/// Synchronises a folder with the disk, so that a renamed file survives a power failure; as far as the system
/// can.
void put_folder_on_disk(const std::filesystem::path& file);

/// A new, empty and locked file for writing, whose name is noted for signal handlers in the same moment; what
/// a process that was stopped left there is removed. Returns the descriptor. Throws std::runtime_error, about
/// `target`, if another process writes the file, if the name belongs to a link, a folder or a device, or if
/// the file cannot be made.
int make_part(const std::filesystem::path& part, const std::filesystem::path& target,
              std::optional<unfinished_name>& name);

/// An open file, which is closed in the end; then a lock of it goes, too.
class descriptor {
 public:
  explicit descriptor(int number = -1) : number_(number) {}
  ~descriptor();
  descriptor(descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  descriptor& operator=(descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }

  int number() const { return number_; }  ///< -1: there is none

 private:
  int number_;
};

/// The regular file of a name, open and locked; without a number if there is no file. Throws file_in_use if
/// another process writes the file, and write_failure if it cannot be opened.
descriptor held(const std::filesystem::path& file);

/// Whether the name still belongs to the open file.
bool has_name(int file, const std::filesystem::path& name);

/// Outcome of asking for a lock.
enum class lock_outcome {
  taken,            ///< no other process holds the lock
  held_by_another,  ///< another process holds it
  unavailable       ///< the file system has no locks, as Lustre mounted without flock, or NFS without lockd
};
/// Asks for the exclusive lock of an open file, without waiting.
lock_outcome ask_for_lock(int file);

/// Whether a process holds the lock of a file, as one does that writes it.
bool is_locked(const std::filesystem::path& file);

/// The file that a link leads to, or the path itself.
std::filesystem::path behind_links(const std::filesystem::path& file);

}  // namespace detail

/// A file that is there whole or not at all: what is written goes into NAME.new.part, and commit() renames
/// it. Without a commit nothing of it is left, and of two processes that write the same file at once the
/// second is refused. A link is followed: the file behind it is replaced.
class atomic_file {
 public:
  /// Makes NAME.new.part. Throws std::runtime_error if it cannot be made, or another process writes it.
  explicit atomic_file(std::filesystem::path path);
  /// NAME.WRITER.part.
  atomic_file(std::filesystem::path path, const std::string& writer);
  ~atomic_file();
  atomic_file(const atomic_file&) = delete;
  atomic_file& operator=(const atomic_file&) = delete;

  /// Appends the text. Throws std::runtime_error if it cannot be written.
  void write(std::string_view text);

  /// Renames the finished file to the name asked for. Throws std::runtime_error if what was written did not
  /// arrive; then an older file is as it was. If it is to be `durable`, it outlasts the machine's power too,
  /// which costs some milliseconds.
  void commit(bool durable = false);

  /// After commit(): the file under its name, still locked, so that no other process writes it.
  detail::descriptor release() { return detail::descriptor(std::exchange(file_, -1)); }

 private:
  void write_gathered();
  [[noreturn]] void fail() const;

  std::filesystem::path path_;
  std::filesystem::path part_;
  std::optional<detail::unfinished_name> name_;
  int file_;
  std::string gathered_;
  bool committed_ = false;
};

}  // namespace nysalt
