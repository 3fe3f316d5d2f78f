// SPDX-License-Identifier: BSL-1.0
#include "unfinished_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <limits>
#include <string>
#include <system_error>
#include <utility>

#include "comparison/refusal.hpp"
#include "nysalt/atomic_file.hpp"

namespace nysalt::program {

namespace {

/// Adds the next bytes of a file, as many as there are up to `length`; how many there were.
std::uint64_t add(boost::crc_32_type& sum, std::istream& file, std::uint64_t length) {
  std::string room(std::size_t{1} << 20U, '\0');
  std::uint64_t done = 0;
  while (done < length && file) {
    file.read(room.data(), static_cast<std::streamsize>(std::min<std::uint64_t>(room.size(), length - done)));
    const auto found = static_cast<std::size_t>(file.gcount());
    sum.process_bytes(room.data(), found);
    done += found;
  }
  return done;
}

}  // namespace

std::optional<file_sum> sum_of(const std::filesystem::path& file, const std::vector<byte_range>& left_out) {
  std::error_code failure;
  const std::uint64_t length = std::filesystem::file_size(file, failure);
  std::ifstream input(file, std::ios::binary);
  if (failure || !input) return std::nullopt;
  boost::crc_32_type sum;
  std::uint64_t at = 0;
  for (const auto& [first, end] : left_out) {
    add(sum, input, first - at);
    input.seekg(static_cast<std::streamoff>(end));
    at = end;
  }
  add(sum, input, std::numeric_limits<std::uint64_t>::max());
  return file_sum{length, sum.checksum()};
}

unfinished_file::descriptor::~descriptor() {
  if (number >= 0) close(number);
}

namespace {

std::filesystem::path part_for(std::filesystem::path file, unfinished_file::origin from) {
  if (from == unfinished_file::origin::disposable) return file += ".new.part";
  if (from == unfinished_file::origin::sorted) return file += ".sorted.part";
  return unfinished_file::part_of(std::move(file));
}

int made_part(const std::filesystem::path& part, const std::filesystem::path& file,
              std::optional<nysalt::detail::unfinished_name>& name) {
  try {
    return nysalt::detail::make_part(part, file, name);
  } catch (const nysalt::detail::write_failure&) {
    throw;
  } catch (const std::runtime_error& problem) {
    throw refusal(problem.what());
  }
}

}  // namespace

unfinished_file::unfinished_file(const std::filesystem::path& file, origin from)
    : path_(nysalt::detail::behind_links(file)),
      part_(part_for(path_, from)),
      is_kept_(from == origin::left_by_another || from == origin::begun_anew) {
  std::error_code ignored;
  if (from == origin::disposable || from == origin::sorted ||
      (from == origin::begun_anew && !std::filesystem::exists(part_, ignored))) {
    file_.number = made_part(part_, path_, name_);
    if (is_kept_) name_.reset();
    return;
  }
  if (std::filesystem::exists(part_, ignored) && !std::filesystem::is_regular_file(part_, ignored)) {
    refuse("cannot write {}: it is not a regular file; name another --output", part_.string());
  }
  const nysalt::detail::held_signals held;  // no handler between the making of the file and `name_`
  const int create = from == origin::made ? O_CREAT : 0;
  file_.number = open(part_.c_str(), O_RDWR | O_NOFOLLOW | O_CLOEXEC | create, 0666);
  if (file_.number < 0 && from == origin::left_by_another && errno == ENOENT) {
    refuse(
        "cannot resume from {}: there is no such file; name the --output of the run to resume, in its folder",
        part_.string());
  }
  if (file_.number < 0 && errno == ELOOP) {
    refuse("cannot write {}: it is a link; remove it, or name another --output", part_.string());
  }
  if (file_.number < 0) fail();
  if (nysalt::detail::ask_for_lock(file_.number) == nysalt::detail::lock_outcome::held_by_another) {
    refuse("cannot write {}: another run is writing it; wait for that run, or name another --output",
           part_.string());
  }
  struct stat opened {};
  // Who held the lock before may have given the file its name meanwhile.
  if (fstat(file_.number, &opened) != 0 || !nysalt::detail::has_name(file_.number, part_)) {
    refuse("cannot write {}: another run has just finished it; take that file, or name another --output",
           path_.string());
  }
  if (from == origin::made && opened.st_size > 0) {
    refuse(
        "cannot write {}: a run that was stopped left it; go on with the checkpoint of that run, or remove "
        "the file",
        part_.string());
  }
  if (from == origin::begun_anew && ftruncate(file_.number, 0) != 0) fail();
  if (!is_kept_) name_.emplace(part_);
}

unfinished_file::~unfinished_file() {
  if (!is_kept_) remove();
}

bool unfinished_file::cut_after(const file_sum& beginning) {
  std::ifstream input(part_, std::ios::binary);
  length_ = add(sum_, input, beginning.length);
  if (written() != beginning) return false;
  if (ftruncate(file_.number, static_cast<off_t>(length_)) != 0) fail();
  return true;
}

void unfinished_file::write(std::string_view text) {
  constexpr std::size_t enough = std::size_t{1} << 20U;
  gathered_ += text;
  length_ += text.size();
  sum_.process_bytes(text.data(), text.size());
  if (gathered_.size() > enough) write_gathered();
}

void unfinished_file::write_gathered() {
  put(length_ - gathered_.size(), std::as_bytes(std::span(gathered_)));
  gathered_.clear();
}

void unfinished_file::put(std::uint64_t at, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t done = pwrite(file_.number, bytes.data(), bytes.size(), static_cast<off_t>(at));
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) fail();
    at += static_cast<std::uint64_t>(done);
    bytes = bytes.subspan(static_cast<std::size_t>(done));
  }
}

void unfinished_file::put_on_disk() {
  write_gathered();
  if (fsync(file_.number) != 0) fail();
}

void unfinished_file::keep() {
  is_kept_ = true;
  name_.reset();
}

void unfinished_file::require_own() const {
  if (nysalt::detail::has_name(file_.number, part_)) return;
  throw nysalt::detail::write_failure(
      message("cannot write {}: another process removed or replaced {}; run it again", path_.string(),
              part_.string()));
}

void unfinished_file::finish() {
  put_on_disk();
  require_own();
  if (const auto why = nysalt::detail::objection_to_replacing(path_); !why.empty()) {
    throw nysalt::detail::write_failure(message("cannot write {}: {}", path_.string(), why));
  }
  std::error_code failure;
  std::filesystem::rename(part_, path_, failure);
  if (failure) {
    throw nysalt::detail::write_failure(message("cannot write {}: {}", path_.string(), failure.message()));
  }
  detail::put_folder_on_disk(path_);
  keep();
}

void unfinished_file::remove() {
  if (!nysalt::detail::has_name(file_.number, part_)) return;  // of another process
  std::error_code ignored;
  std::filesystem::remove(part_, ignored);
}

void unfinished_file::fail() const {
  throw nysalt::detail::write_failure(
      message("cannot write {}: the folder is not there, not writable, or full; mend that, and go on by "
              "--resume where there is a checkpoint",
              part_.string()));
}

}  // namespace nysalt::program
