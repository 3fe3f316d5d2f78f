// SPDX-License-Identifier: BSL-1.0
// What `run` is asked, when all of it can be: a system, a method, and steps.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "comparison/json.hpp"
#include "comparison/method_source.hpp"
#include "comparison/prepared_problem.hpp"
#include "program/settings.hpp"

namespace nysalt::program {

class planned_run {
 public:
  /// Names the observable of the system where none is asked for. Throws refusal for whatever cannot be,
  /// before any work is done.
  planned_run(const run_command& command, const common_settings& common);

  const run_command& command() const { return command_; }
  prepared_problem& system() const { return *system_; }
  const tabulated& method() const { return *method_; }
  trajectories_plan plan() const;

  /// All that decides the bytes of the output, for a run that may be stopped and gone on with.
  json question() const;
  /// What a file of arrays tells of itself: the same, in words too, with versions and units; nothing that
  /// changes from time to time, from machine to machine, or with the number of threads or ranks.
  json about() const;

  /// What is to be said of the method as it is; then also of its steps from these starts, which must be
  /// prepared.
  std::vector<std::string> warnings() const { return warnings_; }
  std::vector<std::string> warnings_of_starts() const;

 private:
  run_command command_;
  common_settings common_;
  std::unique_ptr<prepared_problem> system_;
  std::int64_t steps_;
  method_source source_;
  std::optional<tabulated> method_;
  std::vector<std::string> warnings_;
};

}  // namespace nysalt::program
