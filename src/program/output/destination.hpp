// SPDX-License-Identifier: BSL-1.0
// Where the samples of a run go.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "array_layout.hpp"
#include "comparison/sampled_plan.hpp"
#include "nysalt/atomic_file.hpp"
#include "program/settings.hpp"
#include "restart.hpp"
#include "sample_arrays.hpp"
#include "samples.hpp"

namespace nysalt::program {

/// Where the records of a run go: into a file, into one that the run can go on with if it is stopped, onto
/// standard output; or into the document, where there is one.
class destination {
 public:
  /// Makes the file. `question` is all that decides its bytes, `about` what a file of arrays tells of it.
  /// Throws refusal if the file cannot be made, or gone on with.
  destination(const run_command& command, std::int64_t steps, bool as_json, const json& question,
              const json& about);
  /// A file that did not take its name, and has no checkpoint, does not stay.
  ~destination();
  destination(const destination&) = delete;
  destination& operator=(const destination&) = delete;

  bool is_finished() const { return kept_ && kept_->is_finished(); }
  bool was_changed() const { return kept_ && kept_->was_changed(); }
  /// How far the run is.
  standing from() const { return kept_ ? kept_->from() : standing(); }

  /// Before the first record is taken.
  void begin();
  void take(std::int64_t trajectory, const record& segment);
  /// All before is taken: a checkpoint, if there are any.
  void reached(const standing& at);
  const std::vector<diverged_trajectory>& lost() const { return kept_ ? kept_->lost() : lost_; }

  /// All was taken: the output takes its name.
  void commit();
  /// And what belongs to the output is there too.
  void finish();

  /// Of what was written, of every so many samples.
  first_trajectory read_first(std::int64_t every) const;
  /// Adds to a document where the samples are, or themselves.
  void describe(json& document) const;

 private:
  std::string output_;
  std::size_t columns_;
  std::optional<array_layout> arrays_;
  std::optional<restart> kept_;
  std::optional<atomic_file> table_;     // without a checkpoint
  std::optional<unfinished_file> part_;  // a file of arrays without a checkpoint, until it has its name
  std::unique_ptr<sample_sink> sink_;    // none if the run is finished
  samples* rows_ = nullptr;              // the same sink, if it is one of rows
  std::vector<diverged_trajectory> lost_;
};

}  // namespace nysalt::program
