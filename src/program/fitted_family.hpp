// SPDX-License-Identifier: BSL-1.0
// A family fitted to a system, at a step or along a curve of steps: what `learn` is asked, and what it finds.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "comparison/json.hpp"
#include "comparison/judging.hpp"
#include "comparison/prepared_problem.hpp"
#include "settings.hpp"

namespace nysalt::program {

class fitted_family {
 public:
  /// Throws refusal for bad options, before any work is done.
  fitted_family(const learn_command& command, const common_settings& common);

  /// What is learned is kept in a work file, if there is one.
  void learn(work_file* work = nullptr);

  const prepared_problem& system() const { return *system_; }

  /// Where the letters O are; nothing without a bath.
  const std::optional<placement>& where() const { return plan_.where; }
  /// The purpose that set the loss; empty if a loss was asked for.
  const std::string& purpose() const { return command_.learning.purpose; }
  /// At each of the steps, in their order; one if no curve is asked for.
  const std::vector<learned_scheme>& learned() const { return learned_; }
  /// For each of these, see loses_fewest() of methods.
  const std::vector<std::optional<rival_judgement>>& losing_fewest() const { return losing_fewest_; }
  /// The first that is not usable; null if all are.
  const learned_scheme* unusable() const;

  /// Of the starts, and of data that were not enough; known once it is learned.
  const std::vector<std::string>& warnings() const { return warnings_; }

  /// The fit, as JSON.
  json document() const;
  static json schema();
  /// The scheme file.
  json scheme() const;

 private:
  learn_command command_;
  common_settings common_;
  std::unique_ptr<prepared_problem> system_;
  std::vector<double> steps_;
  learn_plan plan_{};
  std::vector<learned_scheme> learned_;
  std::vector<std::optional<rival_judgement>> losing_fewest_;
  std::vector<std::string> warnings_;
};

}  // namespace nysalt::program
