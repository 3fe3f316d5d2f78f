// SPDX-License-Identifier: BSL-1.0
#include "nysalt/atomic_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

namespace nysalt {

void put_folder_on_disk(const std::filesystem::path& file) {
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
  const int descriptor = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  fsync(descriptor);
  close(descriptor);
}

atomic_file::atomic_file(std::filesystem::path path)
    : atomic_file(std::move(path), std::to_string(getpid())) {}

atomic_file::atomic_file(std::filesystem::path path, const std::string& writer)
    : path_(std::move(path)), part_(path_) {
  part_ += fmt::format(".{}.part", writer);
  stream_.open(part_, std::ios::binary | std::ios::trunc);
  if (!stream_) fail();
}

atomic_file::~atomic_file() {
  if (committed_) return;
  stream_.close();
  std::error_code ignored;
  std::filesystem::remove(part_, ignored);
}

void atomic_file::write(std::string_view text) {
  if (!stream_.write(text.data(), static_cast<std::streamsize>(text.size()))) fail();
}

void atomic_file::commit(bool durable) {
  stream_.close();
  std::error_code failure;
  if (durable && stream_) put_on_disk();
  if (stream_) std::filesystem::rename(part_, path_, failure);
  if (!stream_ || failure) fail();
  if (durable) put_folder_on_disk(path_);
  committed_ = true;
}

void atomic_file::put_on_disk() const {
  const int file = open(part_.c_str(), O_RDONLY | O_CLOEXEC);
  const bool arrived = file >= 0 && fsync(file) == 0;
  if (file >= 0) close(file);
  if (!arrived) fail();
}

void atomic_file::fail() const {
  throw std::runtime_error(
      fmt::format("cannot write {}: is the folder there, writable, and not full?", path_.string()));
}

}  // namespace nysalt
