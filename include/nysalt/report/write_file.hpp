// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <filesystem>
#include <string_view>

#include "nysalt/report/atomic_file.hpp"

namespace nysalt {

/// Writes a file whole or not at all. Throws std::runtime_error if it cannot.
inline void write_file(const std::filesystem::path& path, std::string_view text) {
  atomic_file file(path);
  file.write(text);
  file.commit();
}

}  // namespace nysalt
