// SPDX-License-Identifier: BSL-1.0
// Sampled trajectories, as many at a time as fit into memory.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "nysalt/divergence.hpp"
#include "nysalt/ensemble_run.hpp"
#include "plans.hpp"
#include "prepared_problem.hpp"

namespace nysalt::program {

/// Samples of a trajectory: values of all observables at steps first, first + every, ...
struct record {
  std::int64_t first = 0;
  std::vector<double> values = {};
  std::optional<std::int64_t> diverged_at = {};  // beyond `first`
};
/// Called with further samples of a trajectory, by the number of the trajectory.
using record_taker = std::function<void(std::int64_t, const record&)>;

/// Progress of a run: trajectories before `first` are finished; those after it are as they were saved, and if
/// none were, they have not begun.
struct run_progress {
  std::int64_t first = 0;
  saved_runs batch = {};
  double energy_error = 0.0;  // the largest |H - H_0| at the end of those before `first` that did not diverge

  bool is_new() const { return first == 0 && batch.diverged_at.empty(); }
};

/// Samples along the trajectories of a plan.
struct sampled_plan {
  trajectories_plan trajectories;
  std::vector<std::string> observables;
  std::int64_t every = 1;
  std::optional<std::int64_t> segment = {};  // steps after which to hand over what there is; nothing: all
  // Of rank 0 only:
  run_progress from = {};
  // Called after each segment, if there are any; and whether the run ends there, as a signal was noted.
  std::function<void(const run_progress&, bool ends)> reached = {};
  // Of a run that prolongs another: the runs first .. first + count - 1 as that one left them, all at one
  // step which steps_between_checks divides, in the place of starts.
  std::function<saved_runs(std::int64_t first, std::int64_t count)> left = {};
  // If there are segments: called with the runs of a batch, of which the number of the first is given, at
  // last_check().
  std::function<void(std::int64_t first, const saved_runs&)> ended = {};
};

/// At rank 0 the runs of a batch that begins at trajectory `first` and is not new; elsewhere nothing.
saved_runs runs_at_first(const sampled_plan& plan, std::int64_t first, std::int64_t count,
                         const communicator& ranks);
/// Whether report_segment() is to be called where a segment ends.
bool is_handed_over(const sampled_plan& plan, std::int64_t end);
/// Calls ended(), if it is set and the batch is at its last check, and report_reached() before the end of the
/// batch. Collective.
void report_segment(const sampled_plan& plan, const run_progress& at, std::int64_t end,
                    const communicator& ranks);
/// Calls reached(), if it is set, at rank 0. Throws interrupted at all ranks if one has noted a signal.
/// Collective.
void report_reached(const sampled_plan& plan, const run_progress& at, const communicator& ranks);

/// Steps that take some tenths of a second in all lanes, for callers that check progress.
constexpr std::int64_t short_segment(std::int64_t dimension) {
  return std::max<std::int64_t>(steps_between_checks, 20'000'000 / dimension);
}
/// Upper bound of the steps in one interval of a run of `steps` steps.
inline std::int64_t longest_segment(std::int64_t steps, std::optional<std::int64_t> length) {
  return std::min(std::min(length.value_or(steps), steps) + steps_between_checks, steps);
}

/// The last step of a run at which a longer run checks for divergence too: from there that one can go on.
constexpr std::int64_t last_check(std::int64_t steps) {
  return steps / steps_between_checks * steps_between_checks;
}

/// Step 64 k ends the interval of the multiples of its length in (64 (k - 1), 64 k]. Of a run in segments one
/// ends at last_check().
inline std::int64_t end_of_segment(std::int64_t step, std::int64_t steps, std::optional<std::int64_t> asked) {
  const std::int64_t length = std::min(asked.value_or(steps), steps);
  const std::int64_t next = (step / length + 1) * length;
  const std::int64_t last = asked && step < last_check(steps) ? last_check(steps) : steps;
  return std::min((next + steps_between_checks - 1) / steps_between_checks * steps_between_checks, last);
}

/// Hands records over at rank 0, batch by batch of as many trajectories as fit into memory; in a batch
/// segment by segment, and in a segment in the order of the trajectories. A segment ends at the first
/// multiple of 64 at or beyond each multiple of `segment`, and at the last one of all: divergence is checked
/// there anyway, so that cutting changes nothing in the run. Rank 0's plan says where to begin. Progress is
/// reported in thousandths. Returns the largest |H - H_0| at the end of all trajectories that did not
/// diverge. Collective.
double run(const prepared_problem& system, const method& method, const sampled_plan& plan,
           const record_taker& take, const counter& progress);

/// Takes given states, instead of starts, to the end of a plan: each of dimension() numbers, one trajectory
/// after the other. With the bits of run(); where that is lost all of q and p become NaN. Throws refusal for
/// a state that is not finite; then all are as they were.
void integrate(const prepared_problem& system, const nysalt::method& method, const trajectories_plan& plan,
               std::span<double> q, std::span<double> p, const counter& progress);

}  // namespace nysalt::program
