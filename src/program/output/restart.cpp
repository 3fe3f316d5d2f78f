// SPDX-License-Identifier: BSL-1.0
#include "restart.hpp"

#include <system_error>
#include <utility>

#include "by_trajectory.hpp"
#include "comparison/refusal.hpp"

namespace nysalt::program {

namespace {

bool is_there(const std::filesystem::path& file) {
  std::error_code ignored;
  return std::filesystem::exists(file, ignored);
}

}  // namespace

restart::restart(const std::filesystem::path& output, const std::filesystem::path& checkpoint,
                 const json& question, bool resume, std::optional<array_layout> arrays)
    : output_(output), file_(checkpoint), arrays_(std::move(arrays)) {
  if (resume) {
    take_up(question);
  } else {
    state_.question = question;
    begin();
  }
}

restart::~restart() {
  if (!is_fresh_) return;
  part_->remove();
  std::error_code ignored;
  std::filesystem::remove(file_, ignored);
}

void restart::begin() {
  if (is_there(file_) && !read_checkpoint(file_).finished) {
    refuse("{} is of a run that was stopped: --resume goes on with it, or remove the file to begin anew",
           file_.string());
  }
  state_.output = output_.filename().string();
  part_.emplace(output_);
  try {
    if (arrays_) arrays_->lay_out(*part_);
    if (arrays_) state_.written = sum_in(part_->part()).value_or(file_sum());
    reached({});
  } catch (...) {
    part_->remove();
    throw;
  }
  is_fresh_ = true;
}

void restart::take_up(const json& question) {
  state_ = read_checkpoint(file_);
  require_question(state_, question, file_);
  if (!state_.output.empty() && state_.output != output_.filename()) {
    refuse("{} is of a run with the --output {}, not {}", file_.string(), state_.output, output_.string());
  }
  const auto part = unfinished_file::part_of(output_);
  if (state_.finished) {
    if (!is_there(output_)) {
      refuse("{} says that the run is finished, but there is no {}: remove the checkpoint to begin anew",
             file_.string(), output_.string());
    }
    // The run was stopped right before it took away what it had sorted.
    if (!state_.in_order && is_there(part)) std::filesystem::remove(part);
    return;
  }
  const bool is_whole = state_.at.first == question.at("trajectories");
  if (is_whole && state_.in_order && !is_there(part) && sum_in(output_) == state_.written)
    return;  // or there
  part_.emplace(go_on_with_part());
}

unfinished_file restart::go_on_with_part() const {
  if (!arrays_) return {output_, state_.written};
  auto part = unfinished_file::left_by_another(output_);
  if (sum_in(part.part()) == state_.written) return part;
  refuse(
      "{} is not what the run to resume left there: it was edited or cut; remove the checkpoint to begin "
      "anew",
      part.part().string());
}

std::optional<file_sum> restart::sum_in(const std::filesystem::path& file) const {
  return arrays_ ? arrays_->sum_of_head(file) : sum_of(file);
}

void restart::reached(const standing& at) {
  // Of one trajectory alone what is written is in order, wherever it is cut.
  if (at.wave.diverged_at.size() > 1 && !arrays_) state_.in_order = false;
  part_->put_on_disk();
  warn_of_version(state_, file_);  // only now: the run has taken what it was given
  state_.version.clear();
  state_.at = at;
  is_fresh_ = false;
  if (!arrays_) state_.written = part_->written();
  write_checkpoint(file_, state_);
}

void restart::commit() {
  if (!part_) return;
  if (state_.in_order) {
    part_->finish();
  } else {
    put_by_trajectory(unfinished_file::part_of(output_), output_);
  }
}

void restart::finish() {
  state_.finished = true;
  state_.written = sum_in(output_).value_or(file_sum());
  write_checkpoint(file_, state_);
  if (part_ && !state_.in_order) part_->remove();
}

bool restart::was_changed() const { return sum_in(output_) != state_.written; }

}  // namespace nysalt::program
