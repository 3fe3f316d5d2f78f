// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <filesystem>
#include <string_view>

namespace nysalt {

/// Writes a file whole or not at all. Throws std::runtime_error if it cannot.
void write_file(const std::filesystem::path& path, std::string_view text);

/// Makes a folder, and those it lies in, where there is none. Throws std::runtime_error if it cannot.
void make_folders(const std::filesystem::path& folder);

}  // namespace nysalt
