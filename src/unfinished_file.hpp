// SPDX-License-Identifier: BSL-1.0
// An output that grows over hours, and outlives whoever stops its writer.
#pragma once

#include <boost/crc.hpp>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string_view>

namespace nysalt::program {

/// FILE.part, which becomes FILE when it is finished. One process alone can hold it.
class unfinished_file {
 public:
  static std::filesystem::path part_of(std::filesystem::path file) { return file += ".part"; }

  /// Begins it anew. Throws refusal if another process writes it, or it cannot be made.
  explicit unfinished_file(const std::filesystem::path& file);
  /// Goes on after its first `length` bytes; what follows them is cut off. Throws refusal if it is not there,
  /// shorter, or those bytes have another CRC-32, too.
  unfinished_file(const std::filesystem::path& file, std::uint64_t length, std::uint32_t sum);

  /// Throws refusal if it cannot be written.
  void write(std::string_view text);
  /// Puts on the disk what was written.
  void put_on_disk();
  std::uint64_t length() const { return length_; }
  std::uint32_t sum() const { return sum_.checksum(); }

  /// It becomes FILE. Throws refusal if that cannot be.
  void finish();
  /// FILE was made of it in another way.
  void remove();

 private:
  struct close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  void open(bool anew);
  void require_beginning(std::uint64_t length, std::uint32_t sum);
  [[noreturn]] void fail() const;

  std::filesystem::path path_;
  std::unique_ptr<std::FILE, close> file_;
  std::uint64_t length_ = 0;
  boost::crc_32_type sum_;
};

/// Whether a file is of that length and sum.
bool is_file_of(const std::filesystem::path& file, std::uint64_t length, std::uint32_t sum);

}  // namespace nysalt::program
