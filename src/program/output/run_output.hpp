// SPDX-License-Identifier: BSL-1.0
// Output of the samples of a run.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "planned_run.hpp"
#include "run_state.hpp"
#include "samples.hpp"
#include "unfinished_file.hpp"

namespace nysalt::program {

/// Where the records of a run go: into a file that the run can go on with if it is stopped, onto standard
/// output; or into the document, where there is one.
class run_output {
 public:
  /// Makes the file, or goes on where the work file says. Throws refusal if the file cannot be made, for a
  /// state that is not whole, and if the output under way is not what that knows. In a table what follows the
  /// state is cut off. In a file of arrays it is written again, and only what is not in the arrays must be as
  /// it was. A finished run of fewer steps is prolonged: its output stays until the longer one takes its
  /// name. The work file must outlive the output; without one there is no file.
  run_output(const planned_run& planned, work_file* work, bool as_json);
  run_output(const run_output&) = delete;
  run_output& operator=(const run_output&) = delete;

  bool is_finished() const { return state_.finished; }
  /// Whether the output of a finished run is not what the run wrote any more.
  bool was_changed() const { return samples_->sum_in(output_) != state_.written; }
  const std::vector<diverged_trajectory>& lost() const { return state_.lost; }
  /// Of a finished run the largest |H - H_0| at the end.
  double energy_error() const { return state_.at.energy_error; }

  /// Before the first record is taken: the plan begins where the run is, and tells what it reaches.
  void begin(sampled_plan& plan);
  void take(std::int64_t trajectory, const record& segment);
  /// All was taken: the output takes its name.
  void commit();
  /// And what belongs to the output is there too: the work file goes, unless the run may be prolonged.
  void finish();

  /// Of what was written, of every n-th sample.
  first_trajectory read_first(std::int64_t every) const { return samples_->read_first(output_, every); }
  /// The names of the columns, and the rows that were kept for a document.
  void describe(std::vector<std::string>& columns, json& rows);

 private:
  void make();
  void go_on();
  void prolong();
  void reached(const run_progress& at, bool ends);
  void save(const run_progress& at);
  void keep(std::int64_t first, const saved_runs& runs);

  std::string output_;
  work_file* work_;
  std::optional<std::int64_t> every_;  // steps between states that are saved; nothing: as time allows
  bool keeps_work_;
  std::int64_t steps_;
  sampled_shape shape_;
  std::int64_t dimension_;
  bool is_of_arrays_;
  run_state state_;
  run_progress last_;                    // that was reached, without its numbers
  std::optional<unfinished_file> part_;  // none once it has its name
  std::unique_ptr<sample_writer> samples_;
};

}  // namespace nysalt::program
