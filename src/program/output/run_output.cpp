// SPDX-License-Identifier: BSL-1.0
#include "run_output.hpp"

#include <algorithm>
#include <cstddef>
#include <string_view>

#include "comparison/inputs.hpp"
#include "comparison/refusal.hpp"
#include "program/output.hpp"
#include "written_arrays.hpp"

namespace nysalt::program {

run_output::run_output(const planned_run& planned, work_file* work, bool as_json)
    : output_(planned.command.output),
      work_(work),
      every_(planned.command.every),
      keeps_work_(planned.command.keep_work),
      steps_(planned.plan.steps),
      shape_{planned.plan.count, planned.plan.steps / planned.command.sample_every + 1,
             planned.command.observables, planned.command.step, planned.command.sample_every},
      dimension_(planned.system->dimension()),
      is_of_arrays_(is_of_arrays(output_)) {
  if (is_of_arrays_) {
    samples_ = array_writer(output_, shape_, planned.about());
  } else if (output_.empty() && as_json) {
    samples_ = table_writer(shape_, {}, nullptr);
  } else {
    samples_ = table_writer(shape_, planned.about(), [this](std::string_view text) {
      if (part_) return part_->write(text);
      print(text);
    });
  }
  if (work_ == nullptr) return;
  if (work_->is_empty()) {
    make();
  } else {
    go_on();
  }
}

void run_output::make() {
  state_.steps = steps_;
  state_.keeps_all = keeps_work_ && shape_.trajectories <= most_numbers_of_all / (3 * dimension_);
  part_.emplace(output_, unfinished_file::origin::made);
  samples_->lay_out(*part_);
  if (is_of_arrays_) state_.written = samples_->sum_in(part_->part()).value_or(file_sum());
}

void run_output::go_on() {
  state_ = saved_in(*work_, steps_, shape_.trajectories, dimension_);
  const auto part = unfinished_file::part_of(output_);
  if (state_.finished) {
    if (!is_there(output_)) {
      refuse(
          "cannot resume from {}: the run is finished, but there is no {}; remove the work file to begin "
          "anew",
          work_of(output_).string(), output_);
    }
    if (state_.steps != steps_) return prolong();
    return;
  }
  // The run was stopped when the output had its name: rows that were sorted are no longer in the part.
  const bool is_whole = state_.at.first == shape_.trajectories && !is_there(part);
  if (is_whole && (state_.in_order ? samples_->sum_in(output_) == state_.written : is_there(output_))) return;
  part_.emplace(output_, unfinished_file::origin::left_by_another);
  if (samples_->go_on(*part_, state_.written)) return;
  refuse(
      "cannot resume from {}: the file was edited or cut after the run had been stopped; remove the work "
      "file "
      "to begin anew",
      part.string());
}

void run_output::prolong() {
  sampled_shape before = shape_;
  before.samples = state_.steps / shape_.every + 1;
  const auto earlier = is_of_arrays_ ? array_writer(output_, before, {}) : table_writer(before, {}, nullptr);
  if (earlier->sum_in(output_) != state_.written) {
    refuse(
        "cannot prolong the run of {}: the file was changed after its end; put the file back, or begin anew",
        output_);
  }
  part_.emplace(output_, unfinished_file::origin::made);
  state_.began = last_check(state_.steps);
  std::erase_if(state_.lost, [&](const auto& one) { return one.step > state_.began; });
  state_.steps = steps_;
  // Rows of several trajectories follow those of all, and are sorted in the end.
  state_.in_order = is_of_arrays_ || shape_.trajectories == 1 || state_.began == 0;
  state_.finished = false;
  samples_->lay_out(*part_);
  if (state_.began > 0) samples_->copy(output_, *part_, before, state_.began);
  if (is_of_arrays_) state_.written = samples_->sum_in(part_->part()).value_or(file_sum());
  part_->put_on_disk();
  part_->keep();
  save({});
}

void run_output::keep(std::int64_t first, const saved_runs& runs) {
  const auto begin = static_cast<std::size_t>(state_.keeps_all ? first * 3 * dimension_ : 0);
  if (state_.keeps_all) {
    state_.numbers.resize(std::max(state_.numbers.size(), begin + runs.numbers.size()));
  } else {
    state_.numbers.resize(runs.numbers.size());
  }
  std::ranges::copy(runs.numbers, state_.numbers.begin() + static_cast<std::ptrdiff_t>(begin));
}

void run_output::save(const run_progress& at) {
  state_.at = at;
  if (!at.batch.diverged_at.empty() || !state_.keeps_all) keep(at.first, at.batch);
  state_.at.batch.numbers.clear();
  if (!is_of_arrays_) state_.written = part_->written();
  program::save(state_, *work_);
}

void run_output::begin(sampled_plan& plan) {
  if (state_.at.is_new() && state_.began == 0) samples_->begin();
  plan.from = state_.at;
  if (state_.began > 0) {
    plan.left = [this](std::int64_t first, std::int64_t count) {
      return runs_of(state_, state_.began, first, count, dimension_);
    };
  }
  if (state_.keeps_all)
    plan.ended = [this](std::int64_t first, const saved_runs& runs) { keep(first, runs); };
  last_ = state_.at;
  last_.batch = {.step = last_.batch.step, .numbers = {}, .diverged_at = {}};
  plan.reached = [this](const run_progress& at, bool ends) { reached(at, ends); };
}

void run_output::take(std::int64_t trajectory, const record& segment) {
  samples_->take(trajectory, segment);
  if (segment.diverged_at) state_.lost.push_back({trajectory, *segment.diverged_at});
}

void run_output::reached(const run_progress& at, bool ends) {
  if (work_ == nullptr) return;
  // Of a single trajectory what is written is in order, wherever it is cut.
  if (at.batch.diverged_at.size() > 1 && !is_of_arrays_) state_.in_order = false;
  const bool is_due = every_
                          ? at.first != last_.first || at.batch.step / *every_ != last_.batch.step / *every_
                          : work_->is_due();
  const bool is_last = at.first == shape_.trajectories;  // commit() follows
  if ((is_due && !is_last) || ends) {
    samples_->flush();
    part_->put_on_disk();
    part_->keep();
    save(at);
  }
  last_.first = at.first;
  last_.batch.step = at.batch.step;
  last_.energy_error = at.energy_error;
}

void run_output::commit() {
  if (!part_) return;
  samples_->flush();
  part_->put_on_disk();
  // Of a run that has saved nothing nothing is gone on with.
  if (keeps_work_ || !work_->is_empty()) {
    part_->keep();
    save(last_);
  }
  if (state_.in_order) {
    part_->finish();
  } else {
    part_->require_own();
    put_by_trajectory(part_->part(), output_, shape_.trajectories);
  }
}

void run_output::finish() {
  if (work_ == nullptr) return;
  if (keeps_work_) {
    state_.finished = true;
    state_.written = samples_->sum_in(output_).value_or(file_sum());
    program::save(state_, *work_);
  }
  if (part_ && !state_.in_order) part_->remove();
  if (!keeps_work_) work_->remove();
}

void run_output::describe(std::vector<std::string>& columns, json& rows) {
  samples_->describe(columns, rows);
}

}  // namespace nysalt::program
