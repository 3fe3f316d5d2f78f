// SPDX-License-Identifier: BSL-1.0
// A checkpoint as a file: what was asked, and where the work is.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "comparison/json.hpp"

namespace nysalt::program {

/// Throws std::runtime_error if the checkpoint cannot be written, and refusal if the checkpoint would be too
/// large to be read; then an older one is as it was. The checkpoint is on the disk when the function returns,
/// for which some milliseconds go by. The file has one line of JSON, doubles (the least byte first), and a
/// line with the CRC-32 of all before it. `check` is called when no other process can write the file any
/// more, and may throw because of what is there.
void write_checkpoint_file(const std::filesystem::path& file, const json& head,
                           std::span<const double> numbers, const std::function<void()>& check = {});

/// Throws refusal for an output in the place of a checkpoint of any run or chains, or a journal of a
/// comparison, that have not finished.
void require_no_checkpoint(const std::filesystem::path& output);

/// The line of JSON of a checkpoint, beside what is its own and its origin(): `command`, `question` (all that
/// decides the bytes of the output). Throws refusal for what is no checkpoint of that command, not whole,
/// edited, or of a newer format. Memory: that of the line.
json head_of_checkpoint(const std::filesystem::path& file, const std::string& command);

/// The doubles of a checkpoint, `count` of them; to be read when the question was compared. Throws refusal
/// for another count, before any is read.
std::vector<double> numbers_of_checkpoint(const std::filesystem::path& file, std::size_t count);

/// For a file that is whole, but not of a run.
[[noreturn]] void refuse_edited_checkpoint(const std::filesystem::path& file);

/// A count of the head. Throws std::exception unless it is a whole number, and not negative.
std::int64_t count_in(const json& value);

/// Throws refusal, naming what differs, if the checkpoint is of another question.
void require_question(const json& asked_then, const json& question, const std::filesystem::path& file);
}  // namespace nysalt::program
