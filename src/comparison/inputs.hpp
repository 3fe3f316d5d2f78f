// SPDX-License-Identifier: BSL-1.0
// Files that were read: no result may take the place of one.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace nysalt::program {

/// Throws refusal for what may have no end, as a device or a FIFO, which no process may write to. Pipes of
/// the shell may be read, as /dev/stdin and /dev/fd/N.
void require_readable(const std::filesystem::path& file);

/// Whether a file, folder or other node is there, behind links; false also where that cannot be found out.
bool is_there(const std::filesystem::path& file);

/// Notes a file that is about to be read, which must be readable. Thread-safe.
void note_input(const std::filesystem::path& file);

/// Notes a file and reads it; of what is longer than `longest` the first longest + 1 bytes. Throws refusal,
/// which says to name `what`, for a file that cannot be read.
std::string contents_of(const std::filesystem::path& file, std::size_t longest, std::string_view what);

/// Forgets the files noted so far, where a process begins with another command line. Thread-safe.
void forget_inputs();

/// Whether the path leads to a file that was read.
bool is_input(const std::filesystem::path& file);

/// The name of an output, behind links, and the names beside it of what is unfinished of it.
std::vector<std::filesystem::path> names_while_written(const std::filesystem::path& output);

/// Throws refusal if a file that was read has the name of the output, or one beside it of what is unfinished.
void require_no_input(const std::filesystem::path& output);

/// The same, and if something is there that is no regular file.
void require_replaceable(const std::filesystem::path& output);

}  // namespace nysalt::program
