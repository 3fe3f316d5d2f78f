// SPDX-License-Identifier: BSL-1.0
// Where the samples of a run go.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "bundled_system.hpp"
#include "nysalt/report/atomic_file.hpp"
#include "output.hpp"
#include "restart.hpp"
#include "samples.hpp"
#include "settings.hpp"

namespace nysalt::program {

/// Where the lines of a run go: into a file, into one that it can go on with if it is stopped, onto standard
/// output; or nowhere, where there is a document.
class destination {
 public:
  destination(const run_command& command, bool as_json, const json& question) : as_json_(as_json) {
    if (!command.checkpoint.empty()) {
      kept_.emplace(command.output, command.checkpoint, question, command.resume);
    } else if (!command.output.empty()) {
      file_.emplace(command.output);
    }
  }

  bool is_finished() const { return kept_ && kept_->is_finished(); }
  bool was_changed() const { return kept_ && kept_->was_changed(); }
  samples::sink lines() {
    if (kept_) return [this](std::string_view text) { kept_->write(text); };
    if (file_) return [this](std::string_view text) { file_->write(text); };
    if (as_json_) return {};
    return [](std::string_view text) { print(text); };
  }
  /// What of a plan is done, and how to be told of more.
  void take_up(sampled_plan& plan, std::optional<std::int64_t> every) {
    if (!kept_) return;
    plan.stretch = every;
    plan.from = kept_->from();
    plan.reached = [this](const standing& at) { kept_->reached(at); };
  }
  void lose(const diverged_trajectory& one) { kept_ ? kept_->lose(one) : lost_.push_back(one); }
  const std::vector<diverged_trajectory>& lost() const { return kept_ ? kept_->lost() : lost_; }

  /// All lines were written: the output takes its name.
  void commit() {
    if (kept_) kept_->commit();
    if (file_) file_->commit();
  }
  /// And what belongs to it is there too.
  void finish() {
    if (kept_) kept_->finish();
  }

 private:
  bool as_json_;
  std::optional<restart> kept_;
  std::optional<atomic_file> file_;
  std::vector<diverged_trajectory> lost_;
};

}  // namespace nysalt::program
