// SPDX-License-Identifier: BSL-1.0
#include "unfinished_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <limits>
#include <string>
#include <system_error>

#include "comparison/refusal.hpp"
#include "nysalt/atomic_file.hpp"

namespace nysalt::program {

namespace {

/// Adds the next bytes of a file, as many as there are up to `length`; how many there were.
std::uint64_t add(boost::crc_32_type& sum, std::FILE* file, std::uint64_t length) {
  std::string room(std::size_t{1} << 20U, '\0');
  std::uint64_t done = 0;
  while (done < length) {
    const std::size_t wanted = static_cast<std::size_t>(std::min<std::uint64_t>(room.size(), length - done));
    const std::size_t found = std::fread(room.data(), 1, wanted, file);
    sum.process_bytes(room.data(), found);
    done += found;
    if (found < wanted) break;
  }
  return done;
}

}  // namespace

unfinished_file::unfinished_file(const std::filesystem::path& file) : path_(file) { open(true); }

unfinished_file::unfinished_file(const std::filesystem::path& file, const file_sum& beginning) : path_(file) {
  open(false);
  require_beginning(beginning);
}

unfinished_file unfinished_file::left_by_another(const std::filesystem::path& file) {
  unfinished_file result;
  result.path_ = file;
  result.open(false);
  return result;
}

void unfinished_file::open(bool anew) {
  const auto part = part_of(path_);
  std::error_code ignored;
  if (std::filesystem::exists(part, ignored) && !std::filesystem::is_regular_file(part, ignored)) {
    refuse("cannot write {}: it is no ordinary file; name another --output", part.string());
  }
  const int descriptor = ::open(part.c_str(), O_RDWR | O_CLOEXEC | (anew ? O_CREAT : 0), 0666);
  if (descriptor < 0 && !anew && errno == ENOENT) {
    refuse(
        "there is no {}, in which the run to resume left its output: is it this --output, and this folder?",
        part.string());
  }
  if (descriptor < 0) fail();
  file_.reset(fdopen(descriptor, "r+"));
  if (flock(descriptor, LOCK_EX | LOCK_NB) != 0) {
    refuse("{} is being written by another run: wait for it, or name another --output", part.string());
  }
  require_same_file(descriptor);
  std::error_code failure;
  if (anew && std::filesystem::file_size(part, failure) > 0) {
    refuse("{} was left by a run that was stopped: go on with its checkpoint, or remove the file",
           part.string());
  }
}

/// Who held the lock before may have given the file its name meanwhile.
void unfinished_file::require_same_file(int descriptor) const {
  struct stat opened {};
  struct stat named {};
  const bool is_known = fstat(descriptor, &opened) == 0 && stat(part_of(path_).c_str(), &named) == 0;
  if (is_known && opened.st_ino == named.st_ino && opened.st_dev == named.st_dev) return;
  refuse("{} was just finished by another run", path_.string());
}

void unfinished_file::require_beginning(const file_sum& beginning) {
  const auto [length, crc] = beginning;
  if (add(sum_, file_.get(), length) != length || sum_.checksum() != crc) {
    refuse(
        "{} is not what the run to resume left there: it was edited or cut; remove the checkpoint to begin "
        "anew",
        part_of(path_).string());
  }
  length_ = length;
  const auto at = static_cast<off_t>(length);
  if (ftruncate(fileno(file_.get()), at) != 0 || fseeko(file_.get(), at, SEEK_SET) != 0) fail();
}

void unfinished_file::write(std::string_view text) {
  if (std::fwrite(text.data(), 1, text.size(), file_.get()) != text.size()) fail();
  length_ += text.size();
  sum_.process_bytes(text.data(), text.size());
}

void unfinished_file::put(std::uint64_t at, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t done = pwrite(fileno(file_.get()), bytes.data(), bytes.size(), static_cast<off_t>(at));
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) fail();
    at += static_cast<std::uint64_t>(done);
    bytes = bytes.subspan(static_cast<std::size_t>(done));
  }
}

void unfinished_file::put_on_disk() {
  if (std::fflush(file_.get()) != 0 || fsync(fileno(file_.get())) != 0) fail();
}

void unfinished_file::finish() {
  put_on_disk();
  std::error_code failure;
  std::filesystem::rename(part_of(path_), path_, failure);
  if (failure) refuse("cannot write {}: {}", path_.string(), failure.message());
  put_folder_on_disk(path_);
  file_.reset();
}

void unfinished_file::remove() {
  std::error_code ignored;
  std::filesystem::remove(part_of(path_), ignored);
  file_.reset();
}

void unfinished_file::fail() const {
  refuse("cannot write {}: is the folder there, writable, and not full? From a checkpoint --resume goes on",
         part_of(path_).string());
}

std::optional<file_sum> sum_of(const std::filesystem::path& file, const std::vector<byte_range>& left_out) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> opened(std::fopen(file.c_str(), "rb"), std::fclose);
  if (!opened) return std::nullopt;
  boost::crc_32_type sum;
  std::uint64_t at = 0;
  for (const auto& [first, end] : left_out) {
    add(sum, opened.get(), first - at);
    if (fseeko(opened.get(), static_cast<off_t>(end), SEEK_SET) != 0) return std::nullopt;
    at = end;
  }
  add(sum, opened.get(), std::numeric_limits<std::uint64_t>::max());
  if (fseeko(opened.get(), 0, SEEK_END) != 0) return std::nullopt;
  return file_sum{static_cast<std::uint64_t>(ftello(opened.get())), sum.checksum()};
}

}  // namespace nysalt::program
