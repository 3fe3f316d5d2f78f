// SPDX-License-Identifier: BSL-1.0
#include "unfinished_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <string>
#include <system_error>

#include "refusal.hpp"

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

unfinished_file::unfinished_file(const std::filesystem::path& file, std::uint64_t length, std::uint32_t sum)
    : path_(file) {
  open(false);
  require_beginning(length, sum);
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
  if (anew && ftruncate(descriptor, 0) != 0) fail();
}

void unfinished_file::require_beginning(std::uint64_t length, std::uint32_t sum) {
  const bool is_there = add(sum_, file_.get(), length) == length && sum_.checksum() == sum;
  if (!is_there) {
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

void unfinished_file::put_on_disk() {
  if (std::fflush(file_.get()) != 0 || fsync(fileno(file_.get())) != 0) fail();
}

void unfinished_file::finish() {
  put_on_disk();
  std::error_code failure;
  std::filesystem::rename(part_of(path_), path_, failure);
  if (failure) refuse("cannot write {}: {}", path_.string(), failure.message());
  file_.reset();
}

void unfinished_file::remove() {
  std::error_code ignored;
  std::filesystem::remove(part_of(path_), ignored);
  file_.reset();
}

void unfinished_file::fail() const {
  refuse("cannot write {}: is the folder there, writable, and not full? With --resume the run goes on",
         part_of(path_).string());
}

bool is_file_of(const std::filesystem::path& file, std::uint64_t length, std::uint32_t sum) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> opened(std::fopen(file.c_str(), "rb"), std::fclose);
  if (!opened) return false;
  boost::crc_32_type its;
  return add(its, opened.get(), length) == length && std::fgetc(opened.get()) == EOF && its.checksum() == sum;
}

}  // namespace nysalt::program
