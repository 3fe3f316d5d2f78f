// SPDX-License-Identifier: BSL-1.0
// State of a run in its work file, from which it is resumed.
#pragma once

#include <cstdint>
#include <vector>

#include "comparison/json.hpp"
#include "comparison/sampled_run.hpp"
#include "comparison/work_file.hpp"
#include "nysalt/divergence.hpp"
#include "unfinished_file.hpp"

namespace nysalt::program {

/// Of `run`.
struct run_state {
  std::int64_t steps = 0;  // of each trajectory, in all
  run_progress at;         // in the work file its numbers are among these:
  std::vector<double>
      numbers;             // of the open runs of all trajectories, in their order, as far as they are known
  std::int64_t began = 0;  // at the step at which another run left them, if it prolongs that; else 0
  bool keeps_all = false;  // not only those of the batch under way
  std::vector<diverged_trajectory> lost;  // so far, as they were found
  file_sum written;                       // of the unfinished output; in the end of the finished one
  bool in_order = true;                   // the unfinished output is what the finished one will be
  bool finished = false;                  // the output is there
};

/// On the disk when the function returns, for which some milliseconds go by.
void save(const run_state& state, work_file& work);

/// The state of a run of `steps` steps, trajectories and coordinates as these; or of a finished one that this
/// run prolongs, which has more steps. Throws refusal if it is not whole, or was edited, and where the run
/// has another number of steps and cannot be prolonged.
run_state saved_in(const work_file& work, std::int64_t steps, std::int64_t trajectories,
                   std::int64_t dimension);

/// Numbers that a state keeps of all trajectories at most, of 8 bytes each.
constexpr std::int64_t most_numbers_of_all = std::int64_t{1} << 25U;

/// The runs first .. first + count - 1 at a step at which their numbers were taken.
saved_runs runs_of(const run_state& state, std::int64_t step, std::int64_t first, std::int64_t count,
                   std::int64_t dimension);

}  // namespace nysalt::program
