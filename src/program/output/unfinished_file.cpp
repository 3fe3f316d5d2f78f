// SPDX-License-Identifier: BSL-1.0
#include "unfinished_file.hpp"

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

namespace {

std::filesystem::path part_for(std::filesystem::path file, unfinished_file::origin from) {
  if (from == unfinished_file::origin::sorted) return file += ".sorted.part";
  return unfinished_file::part_of(std::move(file));
}

nysalt::detail::descriptor opened_part(const std::filesystem::path& part, const std::filesystem::path& file,
                                       unfinished_file::origin from,
                                       std::optional<nysalt::detail::unfinished_name>& name) {
  try {
    if (from != unfinished_file::origin::left_by_another)
      return nysalt::detail::descriptor(nysalt::detail::make_part(part, file, name));
    nysalt::detail::descriptor left = nysalt::detail::held(part);
    if (left.number() >= 0) return left;
  } catch (const nysalt::detail::write_failure&) {
    throw;
  } catch (const std::runtime_error& problem) {
    throw refusal(problem.what());
  }
  refuse(
      "cannot resume from {}: there is no such file; put the file back, or remove the work file to begin "
      "anew",
      part.string());
}

}  // namespace

unfinished_file::unfinished_file(const std::filesystem::path& file, origin from)
    : path_(nysalt::detail::behind_links(file)),
      part_(part_for(path_, from)),
      is_kept_(from == origin::left_by_another),
      file_(opened_part(part_, path_, from, name_)) {}

unfinished_file::~unfinished_file() {
  if (!is_kept_) remove();
}

bool unfinished_file::cut_after(const file_sum& beginning) {
  std::ifstream input(part_, std::ios::binary);
  length_ = add(sum_, input, beginning.length);
  if (written() != beginning) return false;
  std::error_code failure;
  std::filesystem::resize_file(part_, length_, failure);
  if (failure) fail();
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
    const ssize_t done = pwrite(file_.number(), bytes.data(), bytes.size(), static_cast<off_t>(at));
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) fail();
    at += static_cast<std::uint64_t>(done);
    bytes = bytes.subspan(static_cast<std::size_t>(done));
  }
}

void unfinished_file::put_on_disk() {
  write_gathered();
  if (fsync(file_.number()) != 0) fail();
}

void unfinished_file::keep() {
  is_kept_ = true;
  name_.reset();
}

void unfinished_file::require_own() const {
  if (nysalt::detail::has_name(file_.number(), part_)) return;
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
  if (!nysalt::detail::has_name(file_.number(), part_)) return;  // of another process
  std::error_code ignored;
  std::filesystem::remove(part_, ignored);
}

void unfinished_file::fail() const {
  throw nysalt::detail::write_failure(
      message("cannot write {}: the folder is not there, not writable, or full; mend that, and go on by "
              "--resume",
              part_.string()));
}

}  // namespace nysalt::program
