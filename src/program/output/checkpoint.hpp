// SPDX-License-Identifier: BSL-1.0
// What a run leaves on disk to go on from, should it be stopped.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "comparison/json.hpp"
#include "comparison/sampled_run.hpp"
#include "nysalt/detail/divergence.hpp"
#include "unfinished_file.hpp"

namespace nysalt::program {

/// A file of one line of JSON, the open runs (doubles, the least byte first), and a line with the CRC-32 of
/// all before it.
struct checkpoint {
  json question;       // all that decides the bytes of the output
  std::string output;  // the name of its file, wherever that is
  run_progress at;
  std::vector<diverged_trajectory> lost;  // so far, as they were found
  file_sum written;                       // of the unfinished output; in the end of the finished one
  bool in_order = true;                   // the unfinished output is what the finished one will be
  bool finished = false;                  // the output is there
  std::string version;                    // of the program that wrote it; empty: of this one
};

/// Throws std::runtime_error if the checkpoint cannot be written; then an older one is as it was. The
/// checkpoint is on the disk when the function returns, for which some milliseconds go by.
void write_checkpoint(const std::filesystem::path& file, const checkpoint& state);

/// Throws refusal for what is none, not whole, edited, or of a newer format.
checkpoint read_checkpoint(const std::filesystem::path& file);

/// Throws refusal, naming what differs, if the checkpoint is of another run.
void require_question(const checkpoint& state, const json& question, const std::filesystem::path& file);

/// Of going on with what another version of the program wrote. To be told when nothing will be refused any
/// more, as a refusal is one line.
void warn_of_version(const checkpoint& state, const std::filesystem::path& file);

}  // namespace nysalt::program
