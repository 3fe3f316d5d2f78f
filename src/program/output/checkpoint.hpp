// SPDX-License-Identifier: BSL-1.0
// Checkpoint of a run, from which it is resumed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "comparison/json.hpp"
#include "comparison/sampled_run.hpp"
#include "nysalt/detail/divergence.hpp"
#include "unfinished_file.hpp"

namespace nysalt::program {

/// Of `run`: its numbers are those of the open runs.
struct checkpoint {
  json question;       // all that decides the bytes of the output
  std::string output;  // the name of its file, wherever that is
  run_progress at;
  std::vector<diverged_trajectory> lost;  // so far, as they were found
  file_sum written;                       // of the unfinished output; in the end of the finished one
  bool in_order = true;                   // the unfinished output is what the finished one will be
  bool laid_out = true;                   // the unfinished output has its beginning, or its arrays
  bool finished = false;                  // the output is there
  std::string version;                    // of the program that wrote it; empty: of this one
};

/// As write_checkpoint_file().
void write_checkpoint(const std::filesystem::path& file, const checkpoint& state,
                      const std::function<void()>& check = {});

/// Checkpoint of a run of a system with `dimension` coordinates. Throws refusal as head_of_checkpoint(),
/// require_question() and numbers_of_checkpoint() do.
checkpoint read_checkpoint(const std::filesystem::path& file, const json& question, std::int64_t dimension);

/// Whether a checkpoint is of a run that is not finished. Throws refusal as head_of_checkpoint() does.
bool is_of_unfinished_run(const std::filesystem::path& file);

}  // namespace nysalt::program
