// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

namespace nysalt {

/// So that a file which has just got its name keeps it when the power fails; as far as the system can.
inline void put_folder_on_disk(const std::filesystem::path& file) {
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
  const int its = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (its < 0) return;
  fsync(its);
  close(its);
}

/// A file that is there whole or not at all: what is written goes into NAME.WRITER.part, and commit()
/// renames it. Without a commit nothing of it is left, and programs that write the same file at once do not
/// mix, as the writer is the process.
class atomic_file {
 public:
  /// Makes NAME.WRITER.part. Throws std::runtime_error if it cannot be made.
  explicit atomic_file(std::filesystem::path path, const std::string& writer = std::to_string(getpid()))
      : path_(std::move(path)), part_(path_) {
    part_ += fmt::format(".{}.part", writer);
    stream_.open(part_, std::ios::binary | std::ios::trunc);
    if (!stream_) fail();
  }
  ~atomic_file() {
    if (committed_) return;
    stream_.close();
    std::error_code ignored;
    std::filesystem::remove(part_, ignored);
  }
  atomic_file(const atomic_file&) = delete;
  atomic_file& operator=(const atomic_file&) = delete;

  /// Appends the text. Throws std::runtime_error if it cannot be written.
  void write(std::string_view text) {
    if (!stream_.write(text.data(), static_cast<std::streamsize>(text.size()))) fail();
  }

  /// Gives the file its name. Throws std::runtime_error if what was written did not arrive; then an older
  /// file is as it was. If it is to be `durable`, it outlasts the machine's power too, which costs some
  /// milliseconds.
  void commit(bool durable = false) {
    stream_.close();
    std::error_code failure;
    if (durable && stream_) put_on_disk();
    if (stream_) std::filesystem::rename(part_, path_, failure);
    if (!stream_ || failure) fail();
    if (durable) put_folder_on_disk(path_);
    committed_ = true;
  }

 private:
  void put_on_disk() const {
    const int file = open(part_.c_str(), O_RDONLY | O_CLOEXEC);
    const bool arrived = file >= 0 && fsync(file) == 0;
    if (file >= 0) close(file);
    if (!arrived) fail();
  }

  [[noreturn]] void fail() const {
    throw std::runtime_error(
        fmt::format("cannot write {}: is the folder there, writable, and not full?", path_.string()));
  }

  std::filesystem::path path_;
  std::filesystem::path part_;
  std::ofstream stream_;
  bool committed_ = false;
};

}  // namespace nysalt
