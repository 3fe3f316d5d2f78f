// SPDX-License-Identifier: BSL-1.0
// An output that grows over hours, and outlives the process that writes it.
#pragma once

#include <boost/crc.hpp>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "nysalt/atomic_file.hpp"

namespace nysalt::program {

/// The identity of a file: length and CRC-32.
struct file_sum {
  std::uint64_t length = 0;
  std::uint32_t crc = 0;
  bool operator==(const file_sum&) const = default;
};
/// Bytes first .. end - 1.
struct byte_range {
  std::uint64_t first;
  std::uint64_t end;
};
/// The CRC-32 leaves out some ranges, which do not overlap, in their order. Nothing if the file cannot be
/// read.
std::optional<file_sum> sum_of(const std::filesystem::path& file,
                               const std::vector<byte_range>& left_out = {});

/// FILE.part, which becomes FILE when it is finished. One process at a time can hold the file. One that was
/// made here goes with its writer, until it is kept, also if a signal ends the process. A link is followed:
/// the file behind it is replaced.
class unfinished_file {
 public:
  enum class origin {
    made,            ///< what a process that was stopped left is removed
    sorted,          ///< for the rows in their final order, FILE.sorted.part: the same
    left_by_another  ///< by the run to resume
  };
  static std::filesystem::path part_of(std::filesystem::path file) { return file += ".part"; }

  /// Throws refusal if another process writes the file, or it cannot be opened; to go on with one, if there
  /// is none.
  unfinished_file(const std::filesystem::path& file, origin from);
  ~unfinished_file();
  unfinished_file(const unfinished_file&) = delete;
  unfinished_file& operator=(const unfinished_file&) = delete;

  const std::filesystem::path& part() const { return part_; }
  /// Goes on after the beginning of a file: what follows that is cut off. False if the file is shorter, or
  /// begins otherwise.
  bool cut_after(const file_sum& beginning);
  /// At the end of the file, some megabytes at a time. Throws refusal if the text cannot be written, as put()
  /// does.
  void write(std::string_view text);
  /// Bytes at a place of their own, where nothing is written to the end.
  void put(std::uint64_t at, std::span<const std::byte> bytes);
  /// Puts on the disk what was written.
  void put_on_disk();
  /// From the beginning to the end, so far.
  file_sum written() const { return {length_, sum_.checksum()}; }

  void keep();
  /// Throws write_failure if another process removed or replaced FILE.part.
  void require_own() const;
  /// FILE.part becomes FILE. Throws write_failure as require_own() does, and if renaming fails.
  void finish();
  /// FILE was made of FILE.part in another way.
  void remove();

 private:
  void write_gathered();
  [[noreturn]] void fail() const;

  std::filesystem::path path_;
  std::filesystem::path part_;
  bool is_kept_;
  std::optional<nysalt::detail::unfinished_name> name_;  // until it is kept
  nysalt::detail::descriptor file_;
  std::string gathered_;  // of the end, not written yet
  std::uint64_t length_ = 0;
  boost::crc_32_type sum_;
};

}  // namespace nysalt::program
