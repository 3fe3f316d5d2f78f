// SPDX-License-Identifier: BSL-1.0
// Files that were read: no result may take the place of one.
#pragma once

#include <filesystem>

namespace nysalt::program {

/// Throws refusal for what may have no end, as a device or a FIFO, which no process may write to. Pipes of
/// the shell may be read, as /dev/stdin and /dev/fd/N.
void require_readable(const std::filesystem::path& file);

/// Notes a file that is about to be read, which must be readable. Thread-safe.
void note_input(const std::filesystem::path& file);

/// Whether the path leads to a file that was read.
bool is_input(const std::filesystem::path& file);

/// Throws refusal if the path leads to a file that was read.
void require_no_input(const std::filesystem::path& output);

}  // namespace nysalt::program
