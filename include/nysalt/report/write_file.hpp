// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string_view>

namespace nysalt {

/// Writes a file whole or not at all: into a temporary one beside it, which is then renamed.
/// Throws std::runtime_error if it cannot.
inline void write_file(const std::filesystem::path& path, std::string_view text) {
  auto temporary = path;
  temporary += ".tmp";
  std::ofstream stream(temporary, std::ios::binary | std::ios::trunc);
  stream.write(text.data(), static_cast<std::streamsize>(text.size()));
  stream.close();
  std::error_code failure;
  if (stream) std::filesystem::rename(temporary, path, failure);
  if (!stream || failure) {
    std::error_code ignored;
    std::filesystem::remove(temporary, ignored);
    throw std::runtime_error(
        fmt::format("cannot write {}: is the folder there, writable, and not full?", path.string()));
  }
}

}  // namespace nysalt
