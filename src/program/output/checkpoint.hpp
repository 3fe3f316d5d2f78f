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
#include "nysalt/divergence.hpp"
#include "unfinished_file.hpp"

namespace nysalt::program {

/// Of `run`.
struct checkpoint {
  json question;       // all that decides the bytes of the output
  std::string output;  // the name of its file, wherever that is
  run_progress at;     // in the file its numbers are among these:
  std::vector<double>
      numbers;             // of the open runs of all trajectories, in their order, as far as they are known
  std::int64_t began = 0;  // at the step at which another run left them, if it prolongs that; else 0
  bool keeps_all = true;   // not only those of the batch under way
  std::vector<diverged_trajectory> lost;  // so far, as they were found
  file_sum written;                       // of the unfinished output; in the end of the finished one
  bool in_order = true;                   // the unfinished output is what the finished one will be
  bool laid_out = true;                   // the unfinished output has its beginning, or its arrays
  bool finished = false;                  // the output is there
  bool is_copied = false;                 // and perhaps a part of the output of a longer run
  std::string warning;                    // of another origin(), until it is printed
};

/// As write_checkpoint_file().
void write_checkpoint(const std::filesystem::path& file, const checkpoint& state,
                      const std::function<void()>& check = {});

/// Checkpoint of a run of a system with `dimension` coordinates; or of a finished one that the run of the
/// question prolongs, which has more steps. Throws refusal as head_of_checkpoint(), require_question() and
/// numbers_of_checkpoint() do, and where a run has another number of steps and cannot be prolonged.
checkpoint read_checkpoint(const std::filesystem::path& file, const json& question, std::int64_t dimension);

/// Numbers that a checkpoint keeps of all trajectories at most, of 8 bytes each.
constexpr std::int64_t most_numbers_of_all = std::int64_t{1} << 25U;

/// The runs first .. first + count - 1 at a step at which their numbers were taken.
saved_runs runs_of(const checkpoint& state, std::int64_t step, std::int64_t first, std::int64_t count,
                   std::int64_t dimension);

/// Whether a checkpoint is of a run that is not finished. Throws refusal as head_of_checkpoint() does.
bool is_of_unfinished_run(const std::filesystem::path& file);

}  // namespace nysalt::program
