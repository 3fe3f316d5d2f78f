// SPDX-License-Identifier: BSL-1.0
// Plan of a `run`, checked as a whole: a system, a method, and steps.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "comparison/json.hpp"
#include "comparison/method_source.hpp"
#include "comparison/prepared_problem.hpp"
#include "program/settings.hpp"

namespace nysalt::program {

struct planned_run {
  /// Names the observable of the system where none is asked for. Throws refusal for bad options,
  /// before any work is done.
  planned_run(const run_command& asked, const common_settings& common);

  run_command command;
  std::unique_ptr<prepared_problem> system;
  trajectories_plan plan;
  method_source source;
  std::optional<nysalt::method> method;  // always there
  judgement unchecked;                   // what stands where checks are left out
  std::uint64_t seed;
  std::vector<std::string> warnings;  // of the method as it is

  /// Of its steps from the starts, which must be prepared.
  std::vector<std::string> warnings_of_steps() const;
  /// The judgement of the method at the step: nothing is tried where checks are left out.
  const judgement& judged() const;
  /// What is to be said at the end if the largest |H - H_0| there is not small.
  std::optional<std::string> warning_of_energy(double largest) const;
  /// All that decides the bytes of the output, for a run that may be stopped and gone on with.
  json question() const;
  /// What an output says of itself: the same, in words too, with versions and units; nothing that
  /// changes from time to time, from machine to machine, or with the number of threads or ranks.
  json about() const;
};

}  // namespace nysalt::program
