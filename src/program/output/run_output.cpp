// SPDX-License-Identifier: BSL-1.0
#include "run_output.hpp"

#include <algorithm>
#include <cstddef>
#include <string_view>
#include <system_error>

#include "checkpoint_file.hpp"
#include "comparison/inputs.hpp"
#include "comparison/refusal.hpp"
#include "program/output.hpp"
#include "written_arrays.hpp"

namespace nysalt::program {

namespace {

void remove_if_there(const std::filesystem::path& file) {
  std::error_code ignored;
  std::filesystem::remove(file, ignored);
}

}  // namespace

run_output::run_output(const planned_run& planned, bool as_json)
    : output_(planned.command.output),
      checkpoint_(planned.command.checkpoint),
      every_(planned.command.every.value_or(0)),
      shape_{planned.plan.count, planned.plan.steps / planned.command.sample_every + 1,
             planned.command.observables, planned.command.step, planned.command.sample_every},
      dimension_(planned.system->dimension()),
      is_of_arrays_(is_of_arrays(output_)) {
  const run_command& command = planned.command;
  if (is_of_arrays_) {
    samples_ = array_writer(output_, shape_, planned.about());
  } else if (output_.empty() && as_json) {
    samples_ = table_writer(shape_, {}, nullptr);
  } else {
    samples_ = table_writer(shape_, planned.about(), [this](std::string_view text) {
      if (part_) return part_->write(text);
      if (table_) return table_->write(text);
      print(text);
    });
  }
  if (command.resume) {
    go_on(planned.question());
  } else if (is_of_arrays_ || !checkpoint_.empty()) {
    make_part(planned.question());
  } else if (!output_.empty()) {
    table_.emplace(output_);
  }
}

run_output::~run_output() {
  if (is_fresh_) remove_if_there(checkpoint_);
}

void run_output::require_new_checkpoint() const {
  if (!is_there(checkpoint_) || !is_of_unfinished_run(checkpoint_)) return;
  refuse(
      "cannot write {}: the checkpoint is of a run that was stopped, or is under way; name another file, or, "
      "once no process writes it, take --resume to go on with the run, or remove the file to begin anew",
      checkpoint_.string());
}

void run_output::make_part(const json& question) {
  require_new_checkpoint();
  if (checkpoint_.empty()) {
    part_.emplace(output_, unfinished_file::origin::disposable);
    samples_->lay_out(*part_);
    return;
  }
  part_.emplace(output_, unfinished_file::origin::made);
  state_.question = question;
  state_.output = std::filesystem::path(output_).filename();
  state_.keeps_all = shape_.trajectories <= most_numbers_of_all / (3 * dimension_);
  state_.laid_out = false;  // which may take minutes: a run that is stopped meanwhile begins anew
  save({}, [this] { require_new_checkpoint(); });  // of two runs that begin at once the second is refused
  is_fresh_ = true;
  fresh_name_.emplace(checkpoint_);
  try {
    lay_out();
  } catch (...) {  // a constructor that throws has no destructor
    remove_if_there(checkpoint_);
    throw;
  }
}

void run_output::lay_out() {
  samples_->lay_out(*part_);
  if (is_of_arrays_) state_.written = samples_->sum_in(part_->part()).value_or(file_sum());
  part_->put_on_disk();
  state_.laid_out = true;
  save({});
}

void run_output::go_on(const json& question) {
  state_ = read_checkpoint(checkpoint_, question, dimension_);
  const json name = as_kept(std::filesystem::path(output_).filename().string());
  if (!state_.output.empty() && state_.output != name) {
    refuse("--output must be {}, as in the run of {}, got {}", state_.output, checkpoint_.string(), output_);
  }
  const auto part = unfinished_file::part_of(output_);
  if (state_.finished) {
    if (!is_there(output_)) {
      refuse(
          "cannot resume from {}: the run is finished, but there is no {}; remove the checkpoint to begin "
          "anew",
          checkpoint_.string(), output_);
    }
    if (state_.question != as_kept(question)) return prolong(question);
    // The run was stopped right before it took away what it had sorted, or what a longer one had copied.
    if (!state_.in_order || state_.is_copied) remove_if_there(part);
    return;
  }
  if (!state_.laid_out) {
    part_.emplace(output_, unfinished_file::origin::begun_anew);
    return lay_out();
  }
  const bool is_whole = state_.at.first == question.at("trajectories");
  const bool may_have_name = is_whole && state_.in_order && !is_there(part);
  if (may_have_name && samples_->sum_in(output_) == state_.written) return;
  part_.emplace(output_, unfinished_file::origin::left_by_another);
  if (samples_->go_on(*part_, state_.written)) return;
  refuse(
      "cannot resume from {}: the file was edited or cut after the run had been stopped; remove the "
      "checkpoint to begin anew",
      part.string());
}

void run_output::prolong(const json& question) {
  const auto steps_before = state_.question.at("steps").get<std::int64_t>();
  sampled_shape before = shape_;
  before.samples = steps_before / shape_.every + 1;
  const auto earlier = is_of_arrays_ ? array_writer(output_, before, {}) : table_writer(before, {}, nullptr);
  if (earlier->sum_in(output_) != state_.written) {
    refuse("cannot prolong the run of {}: {} was changed after its end; put the file back, or begin anew",
           checkpoint_.string(), output_);
  }
  const auto from = state_.is_copied ? unfinished_file::origin::begun_anew : unfinished_file::origin::made;
  part_.emplace(output_, from);
  const checkpoint finished = state_;
  state_.is_copied = true;  // from now on the part is of this run, which may be stopped while it copies
  write_checkpoint(checkpoint_, state_);
  try {
    state_.began = last_check(steps_before);
    std::erase_if(state_.lost, [&](const auto& one) { return one.step > state_.began; });
    state_.question = question;
    // Rows of several trajectories follow those of all, and are sorted in the end.
    state_.in_order = is_of_arrays_ || shape_.trajectories == 1 || state_.began == 0;
    state_.finished = false;
    state_.is_copied = false;
    samples_->lay_out(*part_);
    if (state_.began > 0) samples_->copy(output_, *part_, before, state_.began);
    if (is_of_arrays_) state_.written = samples_->sum_in(part_->part()).value_or(file_sum());
    part_->put_on_disk();
    part_->keep();
    save({});
  } catch (...) {
    part_->remove();
    write_checkpoint(checkpoint_, finished);
    throw;
  }
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

void run_output::save(const run_progress& at, const std::function<void()>& check) {
  state_.at = at;
  if (!at.batch.diverged_at.empty() || !state_.keeps_all) keep(at.first, at.batch);
  state_.at.batch.numbers.clear();
  if (!is_of_arrays_) state_.written = part_->written();
  write_checkpoint(checkpoint_, state_, check);
}

void run_output::begin(sampled_plan& plan) {
  if (state_.at.is_new() && state_.began == 0) samples_->begin();
  plan.from = state_.at;
  if (state_.began > 0) {
    plan.left = [this](std::int64_t first, std::int64_t count) {
      return runs_of(state_, state_.began, first, count, dimension_);
    };
  }
  if (state_.keeps_all && !checkpoint_.empty())
    plan.ended = [this](std::int64_t first, const saved_runs& runs) { keep(first, runs); };
  saved_at_ = {state_.at.first, state_.at.batch.step};
  plan.reached = [this](const run_progress& at, bool ends) { reached(at, ends); };
}

void run_output::take(std::int64_t trajectory, const record& segment) {
  samples_->take(trajectory, segment);
  if (segment.diverged_at) state_.lost.push_back({trajectory, *segment.diverged_at});
}

void run_output::reached(const run_progress& at, bool ends) {
  if (checkpoint_.empty()) return;
  // Of a single trajectory what is written is in order, wherever it is cut.
  if (at.batch.diverged_at.size() > 1 && !is_of_arrays_) state_.in_order = false;
  const std::int64_t step = at.batch.step;
  const bool is_due = at.first != saved_at_.first || step / every_ != saved_at_.step / every_;
  if (!is_due && !ends) return;
  saved_at_ = {at.first, step};
  samples_->flush();
  part_->put_on_disk();
  if (!state_.warning.empty()) warn(state_.warning);  // only now: the run has taken what it was given
  state_.warning.clear();
  part_->keep();
  is_fresh_ = false;
  fresh_name_.reset();
  save(at);
}

void run_output::commit() {
  if (table_) table_->commit(true);
  if (!part_) return;
  samples_->flush();
  if (state_.in_order) {
    part_->finish();
  } else {
    part_->require_own();
    put_by_trajectory(part_->part(), output_, shape_.trajectories);
  }
}

void run_output::finish() {
  if (checkpoint_.empty()) return;
  state_.finished = true;
  state_.written = samples_->sum_in(output_).value_or(file_sum());
  write_checkpoint(checkpoint_, state_);
  if (part_ && !state_.in_order) part_->remove();
}

void run_output::describe(std::vector<std::string>& columns, json& rows) {
  samples_->describe(columns, rows);
}

}  // namespace nysalt::program
