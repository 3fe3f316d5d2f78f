// SPDX-License-Identifier: BSL-1.0
#include "write_file.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <string_view>
#include <system_error>

#include "nysalt/atomic_file.hpp"

namespace nysalt {

void write_file(const std::filesystem::path& path, std::string_view text) {
  atomic_file file(path);
  file.write(text);
  file.commit(true);
}

void make_folders(const std::filesystem::path& folder) {
  std::error_code failure;
  std::filesystem::create_directories(folder, failure);
  if (failure) {
    throw detail::write_failure(
        fmt::format("cannot make the folder {}: {}", folder.string(), failure.message()));
  }
}

}  // namespace nysalt
