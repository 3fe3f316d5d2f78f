// SPDX-License-Identifier: BSL-1.0
// Output of the samples of a run.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "checkpoint.hpp"
#include "nysalt/atomic_file.hpp"
#include "planned_run.hpp"
#include "samples.hpp"
#include "unfinished_file.hpp"

namespace nysalt::program {

/// Where the records of a run go: into a file, into one that the run can go on with if it is stopped, onto
/// standard output; or into the document, where there is one. A file that did not take its name does not
/// stay, unless there is a checkpoint from which the run goes on with it.
class run_output {
 public:
  /// Makes the file, or, if the run is to resume, goes on where its checkpoint says. Throws refusal if the
  /// file cannot be made; for a checkpoint that is none, not whole or of another run; to resume, if there is
  /// none or the output under way is not what it knows; to begin, if there is one of a run that was stopped.
  /// In a table what follows the checkpoint is cut off. In a file of arrays it is written again, and only
  /// what is not in the arrays must be as it was. A finished run of fewer steps is prolonged: its output
  /// stays until the longer one takes its name.
  run_output(const planned_run& planned, bool as_json);
  /// Of a run that reached nothing, as it was refused after all, nothing stays.
  ~run_output();
  run_output(const run_output&) = delete;
  run_output& operator=(const run_output&) = delete;

  bool is_finished() const { return state_.finished; }
  /// Whether the output of a finished run is not what the run wrote any more.
  bool was_changed() const { return samples_->sum_in(output_) != state_.written; }
  const std::vector<diverged_trajectory>& lost() const { return state_.lost; }
  /// Of a finished run the largest |H - H_0| at the end.
  double energy_error() const { return state_.at.energy_error; }

  /// Before the first record is taken: the plan begins where the run is, and makes checkpoints, if there are
  /// any.
  void begin(sampled_plan& plan);
  void take(std::int64_t trajectory, const record& segment);
  /// All was taken: the output takes its name.
  void commit();
  /// And what belongs to the output is there too.
  void finish();

  /// Of what was written, of every n-th sample.
  first_trajectory read_first(std::int64_t every) const { return samples_->read_first(output_, every); }
  /// The names of the columns, and the rows that were kept for a document.
  void describe(std::vector<std::string>& columns, json& rows);

 private:
  void require_new_checkpoint() const;
  void make_part(const json& question);
  void lay_out();
  void go_on(const json& question);
  void prolong(const json& question);
  void reached(const run_progress& at, bool ends);
  void save(const run_progress& at, const std::function<void()>& check = {});
  void keep(std::int64_t first, const saved_runs& runs);

  std::string output_;
  std::filesystem::path checkpoint_;  // empty if there are none
  std::int64_t every_;                // steps between checkpoints
  sampled_shape shape_;
  std::int64_t dimension_;
  bool is_of_arrays_;
  checkpoint state_;
  struct {
    std::int64_t first = 0;
    std::int64_t step = 0;
  } saved_at_;                                                 // of the last checkpoint
  bool is_fresh_ = false;                                      // begun here, and no checkpoint but the first
  std::optional<nysalt::detail::unfinished_name> fresh_name_;  // the checkpoint then goes, if a signal comes
  std::optional<unfinished_file> part_;  // of arrays, or with a checkpoint; none once it has its name
  std::optional<atomic_file> table_;     // without a checkpoint
  std::unique_ptr<sample_writer> samples_;
};

}  // namespace nysalt::program
