// SPDX-License-Identifier: BSL-1.0
// Files that were read: no result may take the place of one.
#pragma once

#include <filesystem>

namespace nysalt::program {

/// Notes a file that was read. Thread-safe.
void note_input(const std::filesystem::path& file);

/// Whether the path leads to a file that was read.
bool is_input(const std::filesystem::path& file);

/// Throws refusal if the path leads to a file that was read.
void require_no_input(const std::filesystem::path& output);

}  // namespace nysalt::program
