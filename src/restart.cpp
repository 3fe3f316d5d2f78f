// SPDX-License-Identifier: BSL-1.0
#include "restart.hpp"

#include <system_error>

#include "by_trajectory.hpp"
#include "refusal.hpp"

namespace nysalt::program {

namespace {

bool is_there(const std::filesystem::path& file) {
  std::error_code ignored;
  return std::filesystem::exists(file, ignored);
}

}  // namespace

restart::restart(const std::filesystem::path& output, const std::filesystem::path& checkpoint,
                 const json& question, bool resume)
    : output_(output), file_(checkpoint) {
  if (resume) {
    take_up(question);
  } else {
    its_.question = question;
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
  its_.output = output_.filename().string();
  part_.emplace(output_);
  reached({});
  is_fresh_ = true;
}

void restart::take_up(const json& question) {
  its_ = read_checkpoint(file_);
  require_question(its_, question, file_);
  if (!its_.output.empty() && its_.output != output_.filename()) {
    refuse("{} is of a run with the --output {}, not {}", file_.string(), its_.output, output_.string());
  }
  const auto part = unfinished_file::part_of(output_);
  if (its_.finished) {
    if (!is_there(output_)) {
      refuse("{} says that the run is finished, but there is no {}: remove the checkpoint to begin anew",
             file_.string(), output_.string());
    }
    // It was stopped right before it took away what it had sorted.
    if (!its_.in_order && is_there(part)) std::filesystem::remove(part);
    return;
  }
  const bool is_whole = its_.at.first == question.at("trajectories");
  if (is_whole && its_.in_order && !is_there(part) && sum_of(output_) == its_.written) return;  // or there
  part_.emplace(output_, its_.written);
}

void restart::write(std::string_view text) { part_->write(text); }

void restart::reached(const standing& at) {
  // Of one trajectory alone what is written is in order, wherever it is cut.
  if (at.wave.diverged_at.size() > 1) its_.in_order = false;
  part_->put_on_disk();
  warn_of_version(its_, file_);  // only now: the run has taken what it was given
  its_.version.clear();
  its_.at = at;
  is_fresh_ = false;
  its_.written = part_->written();
  write_checkpoint(file_, its_);
}

void restart::commit() {
  if (!part_) return;
  if (its_.in_order) {
    part_->finish();
  } else {
    put_by_trajectory(unfinished_file::part_of(output_), output_);
  }
}

void restart::finish() {
  its_.finished = true;
  its_.written = sum_of(output_).value_or(file_sum());
  write_checkpoint(file_, its_);
  if (part_ && !its_.in_order) part_->remove();
}

bool restart::was_changed() const { return sum_of(output_) != its_.written; }

}  // namespace nysalt::program
