// SPDX-License-Identifier: BSL-1.0
// The folder of what was compiled: its files are named by their contents, so that any number of processes may
// make the same one at once.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "nysalt/atomic_file.hpp"

namespace nysalt::program {

/// The folder, which is made if it is not there. Throws refusal if it cannot be made, or if others than the
/// user may write it, as what lies in it is run.
std::filesystem::path cache_folder();

/// 128 bits, by which different texts have different names.
std::string name_of(std::string_view text);

/// A file on its way to a name in the cache, by a name that no other process or thread has; removed in any
/// case, also by a signal.
class cache_part {
 public:
  explicit cache_part(std::filesystem::path target);
  ~cache_part();
  cache_part(const cache_part&) = delete;
  cache_part& operator=(const cache_part&) = delete;

  const std::filesystem::path& path() const { return path_; }
  /// Gives the file its name, once all of it is on the disk. Throws detail::write_failure.
  void keep() const;

 private:
  std::filesystem::path target_;
  std::filesystem::path path_;
  nysalt::detail::unfinished_name name_;
};

/// Writes a file of the cache. Throws detail::write_failure.
void write_to_cache(const std::filesystem::path& file, std::string_view text);

/// Removes what processes left that were killed: none takes a day.
void remove_left_parts();

/// Throws detail::write_failure.
[[noreturn]] void cannot_write_to_cache(const std::filesystem::path& file, const std::error_code& problem);

}  // namespace nysalt::program
