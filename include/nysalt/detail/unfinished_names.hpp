// SPDX-License-Identifier: BSL-1.0
// Files that must go if a signal ends the process.
#pragma once

#include <cstddef>
#include <filesystem>

namespace nysalt::detail {

/// The name of a file that is not finished, kept where a signal handler finds it. Of more than 32 at a time
/// the others are not kept.
class unfinished_name {
 public:
  explicit unfinished_name(const std::filesystem::path& file);
  ~unfinished_name();  ///< the file stays in any case
  unfinished_name(const unfinished_name&) = delete;
  unfinished_name& operator=(const unfinished_name&) = delete;

 private:
  std::size_t place_;
};

/// Removes all files whose names are kept. Async-signal-safe.
void remove_unfinished_files() noexcept;

}  // namespace nysalt::detail
