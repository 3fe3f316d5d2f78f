// SPDX-License-Identifier: BSL-1.0
// An output that grows over hours, and outlives whoever stops its writer.
#pragma once

#include <boost/crc.hpp>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace nysalt::program {

/// What a file is known by: its length and CRC-32.
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
/// The CRC-32 leaves out some ranges, which do not overlap, in their order. Nothing if the file
/// cannot be read.
std::optional<file_sum> sum_of(const std::filesystem::path& file,
                               const std::vector<byte_range>& left_out = {});

/// FILE.part, which becomes FILE when it is finished. One process alone can hold the file.
class unfinished_file {
 public:
  static std::filesystem::path part_of(std::filesystem::path file) { return file += ".part"; }

  /// Begins the file. Throws refusal if there is one, which a run that was stopped may need, if another
  /// process writes the file, or the file cannot be made.
  explicit unfinished_file(const std::filesystem::path& file);
  /// Goes on after the beginning of the file; what follows that is cut off. Throws refusal if the file is not
  /// there, shorter, or begins otherwise, too.
  unfinished_file(const std::filesystem::path& file, const file_sum& beginning);
  /// Goes on in the midst of the file, whatever it holds. Throws refusal if the file is not there.
  static unfinished_file left_by_another(const std::filesystem::path& file);

  std::filesystem::path part() const { return part_of(path_); }
  /// At the end of the file. Throws refusal if the text cannot be written.
  void write(std::string_view text);
  /// Bytes at a place of their own, where nothing was written to the end. Throws refusal if the bytes cannot
  /// be written.
  void put(std::uint64_t at, std::span<const std::byte> bytes);
  /// Puts on the disk what was written.
  void put_on_disk();
  file_sum written() const { return {length_, sum_.checksum()}; }

  /// FILE.part becomes FILE. Throws refusal if that cannot be.
  void finish();
  /// FILE was made of FILE.part in another way.
  void remove();

 private:
  struct close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  unfinished_file() = default;
  void open(bool anew);
  void require_same_file(int descriptor) const;
  void require_beginning(const file_sum& beginning);
  [[noreturn]] void fail() const;

  std::filesystem::path path_;
  std::unique_ptr<std::FILE, close> file_;
  std::uint64_t length_ = 0;
  boost::crc_32_type sum_;
};

}  // namespace nysalt::program
